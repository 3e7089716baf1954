"""The comparison as Markdown."""

from arms import ARMS

NOTES = {"mj_inverse": "MuJoCo, mj_inverse (no v_r)"}
CASADI = ("CasADi C, Pinocchio's recursion", "CasADi C, plain recursion")


def markdown(result):
    """All arms in one table, then the ratios that matter, then what was measured with."""
    lines = [
        "| arm | implementation | instructions | operations | ns, median (quartiles) | code bytes | generation, CPU s |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, rows in result["arms"].items():
        for k, row in enumerate(rows):
            low, high = row["ns"]["quartiles"]
            cells = [
                ARMS[name][1] if k == 0 else "",
                row["implementation"],
                number(row["instructions"]),
                number(row.get("operations")),
                f"{number(row['ns']['median'])} ({number(low)}–{number(high)})",
                number(row["code_bytes"]),
                f"{row['seconds']:.2g}" if "seconds" in row else "–",
            ]
            lines.append(f"| {' | '.join(cells)} |")
    lines += ["", *ratios(result), ""]
    versions = ", ".join(f"{name} {version}" for name, version in result["versions"].items())
    lines.append(f"{versions}; {', '.join(result['tools'])}; processor `{result['processor']}`.")
    lines += [f"`{name}` is missing: {reason}" for name, reason in result["missing"].items()]
    most = max(row["deviation"] for rows in result["arms"].values() for row in rows)
    lines.append(f"Largest deviation of any torque from the first row of its arm: {most:.1e} of the largest torque.")
    return "\n".join(lines) + "\n"


def ratios(result):
    """Instructions of our rows as fractions of both CasADi rows."""
    found = []
    for name, rows in result["arms"].items():
        by_name = {row["implementation"]: row for row in rows}
        ours = [row for row in rows if row["implementation"].startswith("Gramforge")]
        for row in ours:
            for peer in filter(by_name.get, CASADI):
                part = row["instructions"] / by_name[peer]["instructions"]
                found.append((ARMS[name][1], row["implementation"], peer, f"{part:.2f}"))
    lines = ["| arm | instructions of | as a fraction of | |", "|---|---|---|---|"]
    return lines + [f"| {' | '.join(cells)} |" for cells in found]


def number(x):
    """1234.5 as 1 234 with a narrow space; nothing known is a dash."""
    return "–" if x is None else f"{x:,.0f}".replace(",", "\u202f")
