"""The comparison as Markdown."""

from arms import KNOWN, OPENSYMORO, REDUCED

INVERSE = "MuJoCo, mj_inverse (no v_r)"
OURS, CASADI = "Gramforge exact", "CasADi C"
BY_HAND = "hand-written C, plain recursion of CasADi"


def markdown(result):
    """A summary for README, then every figure, then what was measured with."""
    tables = [reduced(arm, rows) for arm, rows in result["reduced"].items()]
    plain = inverse_dynamics(result["titles"], result["inverse_dynamics"])
    parts = [summary(result), plain, steps(result), *tables, details(result), footnotes(result)]
    return "\n\n".join("\n".join(lines) for lines in parts if lines) + "\n"


def summary(result):
    """Instructions and operations, one column an arm; below, ours as fractions of each CasADi row."""
    tables = {name: {row["implementation"]: row for row in rows} for name, rows in result["arms"].items()}
    titles = list(next(iter(tables.values())))
    lines = line(["instructions a call (operations)", *(result["titles"][name] for name in tables)])
    lines += line(["---"] * (1 + len(tables)))
    for title in titles:
        rows = [table[title] for table in tables.values()]
        operations = [f" ({number(row['operations'])})" if "operations" in row else "" for row in rows]
        lines += line([title, *(number(row["instructions"]) + count for row, count in zip(rows, operations))])
    ours = [title for title in titles if title.startswith(OURS)]
    for peer in [title for title in titles if title.startswith(CASADI)]:
        for title in ours:
            parts = [table[title]["instructions"] / table[peer]["instructions"] for table in tables.values()]
            lines += line([f"{title} / {peer}", *(f"{part:.2f}" for part in parts)])
    return lines


def inverse_dynamics(titles, counts):
    """Operations of plain inverse dynamics, v_r = q̇, one column an arm."""
    ours, casadi = ({name: count[who] for name, count in counts.items()} for who in ("gramforge", "casadi"))
    rows = [("Gramforge exact, v_r = q̇", ours), ("CasADi C, plain recursion", casadi)]
    rows.append(("OpenSYMORO, base parameters", OPENSYMORO))
    lines = ["Plain inverse dynamics D q̈ + C q̇ + G, operations without sines and cosines:", ""]
    lines += line(["operations", *titles.values()]) + line(["---"] * (1 + len(titles)))
    for title, row in rows:
        lines += line([title, *(number(row.get(name)) for name in titles)])
    for title, row in rows[1:]:
        parts = [f"{ours[name] / row[name]:.2f}" if name in row else "–" for name in titles]
        lines += line([f"{rows[0][0]} / {title}", *parts])
    return lines


def steps(result):
    """Instructions of whole control periods, one column an arm that has a controller."""
    tables = {name: {row["implementation"]: row["instructions"] for row in rows} for name, rows in result["steps"].items()}
    titles = list(dict.fromkeys(title for table in tables.values() for title in table))
    lines = ["Whole control period: reference, law `report`, model, limits.", ""]
    lines += line(["instructions a period", *(result["titles"][name] for name in tables)]) + line(["---"] * (1 + len(tables)))
    for title in titles:
        lines += line([title, *(number(table.get(title)) for table in tables.values())])
    for title in [title for title in titles if title.startswith("Gramforge")]:
        parts = [f"{table[title] / table[BY_HAND]:.2f}" if title in table else "–" for table in tables.values()]
        lines += line([f"{title} / {BY_HAND}", *parts])
    return lines if tables else []


def reduced(arm, rows):
    """The reduced models of one arm beside CasADi's code for the exact one."""
    peers = list(rows[0]["parts"])
    heads = ["tolerance", "sines", "certified", "operations", "instructions", *(f"/ {peer}" for peer in peers)]
    lines = [f"{KNOWN[arm][1]} {REDUCED[arm][1]}, reduced to a part of each joint's peak torque:", ""]
    lines += line([*heads, "code bytes", "source bytes", "generation, CPU s"]) + line(["---"] * (len(heads) + 3))
    for row in rows:
        lines += line(
            [
                f"{100 * row['tolerance']:g} %",
                row["trig"],
                f"{100 * row['certified']:.3f} %",
                number(row["operations"]),
                number(row["instructions"]),
                *(f"{row['parts'][peer]:.2f}" for peer in peers),
                number(row["code_bytes"]),
                number(row["source_bytes"]),
                f"{row['seconds']:.2g}",
            ]
        )
    return lines


def details(result):
    """Every figure, one row an implementation and arm."""
    heads = ["arm", "implementation", "instructions", "operations", "ns, median (quartiles)", "code bytes"]
    lines = line([*heads, "generation, CPU s"]) + line(["---"] * 7)
    for name, rows in result["arms"].items():
        for k, row in enumerate(rows):
            low, high = row["ns"]["quartiles"]
            cells = [
                result["titles"][name] if k == 0 else "",
                row["implementation"],
                number(row["instructions"]),
                number(row.get("operations")),
                f"{number(row['ns']['median'])} ({number(low)}–{number(high)})",
                number(row["code_bytes"]),
                f"{row['seconds']:.2g}" if "seconds" in row else "–",
            ]
            lines += line(cells)
    return lines


def footnotes(result):
    """Versions, what is missing, agreement."""
    versions = ", ".join(f"{name} {version}" for name, version in result["versions"].items())
    lines = [f"{versions}; {', '.join(result['tools'])}; compiled for `{result['processor']}`."]
    lines += [f"`{name}` is missing: {reason}." for name, reason in result["missing"].items()]
    most = max(row["deviation"] for rows in result["arms"].values() for row in rows)
    lines.append(f"Largest deviation of any torque from the first row of its arm: {most:.1e} of the largest torque.")
    return lines


def line(cells):
    return [f"| {' | '.join(cells)} |"]


def number(x):
    """1234.5 as 1 234 with a narrow space; nothing known is a dash."""
    return "–" if x is None else f"{x:,.0f}".replace(",", "\u202f")
