// Figures: pictures, tables, keys and files.

function table(panel) {
  const row = (cells, head) => html("tr", {}, ...cells.map((cell, k) => {
    if (head) return html("th", { scope: "col" }, cell);
    return k === 0 ? html("th", { scope: "row" }, cell) : html("td", {}, cell);
  }));
  const body = html("tbody", {}, ...panel.rows.map((cells) => row(cells, false)));
  const out = html("table", {}, html("caption", {}, panel.title), html("thead", {}, row(panel.head, true)), body);
  return html("section", { class: "scroll", tabindex: "0", "aria-label": panel.title }, out);
}

function tiles(panel) {
  const tile = (t) => html("div", {}, html("dt", {}, t.name), html("dd", { class: "value" }, t.value), html("dd", { class: "note" }, t.note));
  return html("dl", { class: "tiles" }, ...panel.tiles.map(tile));
}

// Figures.

function legend(panels) {
  const known = new Map();
  for (const panel of panels) {
    for (const s of panel.series ?? []) known.set(s.name + s.role, [s.name, s.role, s.low ? "band" : "curve"]);
    for (const [name, role] of panel.parts ?? []) known.set(name + role, [name, role, "fill"]);
    if (panel.kind === "dots") {
      known.set("certified boundcertified", ["certified bound", "certified", "curve"]);
      known.set("largest found by searchfound", ["largest found by search", "found", "curve"]);
    }
  }
  // One kind of bar needs no key.
  if (known.size === 0 || (known.size === 1 && [...known.values()][0][2] === "fill")) return [];
  const entry = ([name, role, kind]) => {
    const shape = kind === "curve" ? { d: "M1 6H27" } : { d: "M1 1H27V11H1Z" };
    return html("li", {}, svg("svg", { viewBox: "0 0 28 12", "aria-hidden": "true" }, svg("path", { class: `${kind} ${style(role)}`, ...shape })), name);
  };
  return [html("ul", { class: "legend" }, ...[...known.values()].map(entry))];
}

function csv(panel) {
  const quote = (cell) => (/[",\n]/.test(cell) ? `"${String(cell).replaceAll('"', '""')}"` : cell ?? "");
  const rows = [];
  if (panel.kind === "lines") {
    rows.push(["curve", named(panel.x), named(panel.y), "lower edge"]);
    for (const s of panel.series) s.x.forEach((x, k) => rows.push([s.name, x, s.y[k], s.low ? s.low[k] : ""]));
  } else if (panel.kind === "bars") {
    rows.push([named(panel.axis), ...panel.parts.map((p) => p[0]), "kept"]);
    for (const r of panel.rows) rows.push([r.label, ...r.values, r.kept]);
  } else if (panel.kind === "dots") {
    rows.push(["size", named(panel.x), `certified, ${named(panel.y)}`, `found, ${named(panel.y)}`]);
    for (const dot of panel.dots) rows.push([dot.label, dot.x, dot.certified, dot.found]);
  } else if (panel.kind === "arm") {
    rows.push(["time (s)", "corner", "x (m)", "y (m)", "z (m)"]);
    panel.corners.forEach((flat, k) => {
      for (let i = 0; i < flat.length; i += 3) rows.push([panel.time[k], i / 3, ...flat.slice(i, i + 3)]);
    });
  } else if (panel.kind === "table") {
    rows.push(panel.head, ...panel.rows);
  } else {
    rows.push(["name", "value", "note"], ...panel.tiles.map((t) => [t.name, t.value, t.note]));
  }
  return rows.map((row) => row.map(quote).join(",")).join("\n") + "\n";
}

function files(id, figure) {
  const list = html("ul", { class: "files" });
  const out = html("details", { class: "data" }, html("summary", {}, "Data of this figure"), list);
  // Made when asked for: most readers never do.
  out.addEventListener("toggle", () => {
    if (list.childElementCount > 0) return;
    figure.panels.forEach((panel, k) => {
      const name = `${data.name}-${id}-${k + 1}.csv`;
      const link = html("a", { download: name, href: `data:text/csv;charset=utf-8,${encodeURIComponent(csv(panel))}` }, name);
      list.append(html("li", {}, link, `: ${panel.title ?? "numbers of this size"}`));
    });
  });
  return out;
}

const drawings = { lines, bars, dots, arm };

/** How many columns a panel takes: 1, "broad" for two, "wide" for all. */
function breadth(panel, figure) {
  if (["arm", "tiles"].includes(panel.kind) || figure.panels.length === 1) return "wide";
  if (panel.kind === "bars" && panel.rows.length > 9) return "wide";
  if (panel.kind === "table") return panel.head.length > 6 ? "wide" : "broad";
  return panel.kind === "dots" ? "broad" : "one";
}

function fill(node) {
  const id = node.dataset.figure;
  const number = data.sizes[current].figures[id];
  const figure = data.figures[number];
  const section = node.closest("section");
  section.hidden = figure === undefined;
  const state = `${number} ${id === "sizes" ? current : ""} ${node.clientWidth}`;
  if (figure === undefined || node.dataset.state === state) return;
  node.dataset.state = state;
  const box = node.querySelector(".panels");
  box.replaceChildren();
  section.querySelectorAll(".legend, .data").forEach((old) => old.remove());
  box.before(...legend(figure.panels));
  const made = figure.panels.map((panel) => {
    const out = html("div", { class: `panel ${breadth(panel, figure)}` });
    if (panel.kind === "table") out.append(table(panel));
    else if (panel.kind === "tiles") out.append(tiles(panel));
    else out.append(html("h3", {}, panel.title));
    box.append(out);
    return out;
  });
  // Widths are known once all are there.
  figure.panels.forEach((panel, k) => {
    const draw = drawings[panel.kind];
    if (draw) made[k].append(plot(panel.title, draw(panel, Math.max(made[k].clientWidth, 260), figure)));
  });
  node.querySelector("figcaption").textContent = figure.caption;
  if (figure.panels.length > 0) node.after(files(id, figure));
  if (id === "sizes") node.querySelectorAll("tbody tr").forEach((row, k) => row.classList.toggle("now", k === current));
}
