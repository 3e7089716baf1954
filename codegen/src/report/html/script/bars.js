// Horizontal bars, and the sizes as dots.

function bars(panel, width) {
  const parts = panel.parts.length;
  const row = panel.stacked ? 30 : 12 * parts + 8;
  const longest = panel.rows.reduce((most, r) => Math.max(most, r.label.length), 4);
  const left = Math.min(7 * longest + 14, 0.42 * width);
  const height = 8 + row * panel.rows.length + 38;
  const bottom = height - 38;
  const sum = (r) => r.values.reduce((a, b) => a + b, 0);
  const values = panel.stacked ? panel.rows.map(sum) : panel.rows.flatMap((r) => r.values);
  const signed = values.some((v) => v < 0);
  const all = panel.axis.logarithmic ? values : values.concat([0]);
  const right = width - (panel.rows.some((r) => r.note) ? 190 : 64);
  const x = scale(all, panel.axis, [left, right], width / 110, !signed);
  const out = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "drawing" });
  for (const value of x.ticks) {
    out.append(svg("line", { class: "grid", x1: x.at(value), x2: x.at(value), y1: 8, y2: bottom }));
    out.append(svg("text", { class: "middle", x: x.at(value), y: bottom + 17 }, tick(value, panel.axis)));
  }
  out.append(svg("text", { class: "middle", x: (left + right) / 2, y: height - 3 }, named(panel.axis)));
  const from = panel.axis.logarithmic ? left : x.at(0);
  const marks = svg("g");
  panel.rows.forEach((r, k) => {
    const top = 8 + row * k;
    const most = Math.floor((left - 10) / 6.6);
    const label = r.label.length > most ? `${r.label.slice(0, most - 1)}…` : r.label;
    out.append(svg("text", { class: "end name", x: left - 8, y: top + row / 2 + 2 }, label));
    let before = 0;
    r.values.forEach((value, p) => {
      if (value === null) return;
      const start = panel.stacked ? x.at(before) : from;
      const end = panel.axis.logarithmic && value <= 0 ? left : x.at(panel.stacked ? before + value : value);
      before += value;
      const [y, thick] = panel.stacked ? [top + 4, row - 12] : [top + 12 * p + 2, 10];
      out.append(svg("rect", {
        class: `${r.kept ? "fill" : "outline"} ${style(panel.parts[p][1])}`,
        x: Math.min(start, end).toFixed(1), y, height: thick, width: Math.max(Math.abs(end - start), 1).toFixed(1),
      }));
      if (!panel.stacked) {
        const side = end < start ? { x: end - 5, class: "end" } : { x: end + 5 };
        out.append(svg("text", { ...side, y: y + 9 }, r.note ?? three(value)));
      }
    });
    if (panel.stacked) out.append(svg("text", { x: x.at(before) + 6, y: top + row / 2 + 2 }, digits(sum(r))));
  });
  out.append(svg("line", { class: "axis", x1: from, x2: from, y1: 8, y2: bottom }), marks);
  const words = (k) => {
    const r = panel.rows[k];
    const list = r.values.map((value, p) => `${panel.parts[p][0]}: ${withUnit(value, panel.axis)}`).concat(r.note ? [r.note] : []);
    return [r.label + (r.kept ? "" : " (left out)"), ...list].join("\n");
  };
  const mark = (k) => {
    marks.replaceChildren();
    if (k !== null) marks.append(svg("rect", { class: "cursor", fill: "none", x: 1, y: 7 + row * k, width: width - 2, height: row - 2 }));
  };
  const near = (px, py) => Math.max(0, Math.min(panel.rows.length - 1, Math.floor((py - 8) / row)));
  return { svg: out, width, steps: panel.rows.length, words, mark, place: (k) => [left, 8 + row * k + row / 2], near };
}

function dots(panel, width) {
  const height = TALL;
  const [left, bottom] = [62, height - 38];
  const errors = panel.dots.flatMap((dot) => [dot.certified, dot.found]);
  const x = scale(panel.dots.map((dot) => dot.x), panel.x, [left, width - EDGE], width / 90);
  const y = scale(errors, panel.y, [bottom - 6, 8], 6);
  const out = frame(width, height, { scale: x, axis: panel.x }, { scale: y, axis: panel.y }, left, bottom);
  const place = (dot) => [x.at(dot.x), y.at(dot.certified ?? panel.y.least)];
  const taken = [];
  panel.dots.forEach((dot, k) => {
    const [px, py] = place(dot);
    if (dot.found !== null && dot.certified !== null) {
      out.append(svg("line", { class: "grid", x1: px, x2: px, y1: py, y2: y.at(dot.found) }));
      out.append(svg("circle", { class: "dot found", cx: px, cy: y.at(dot.found), r: 3 }));
    }
    const chosen = k === current;
    out.append(svg("circle", { class: `dot certified${chosen ? " chosen" : ""}`, cx: px, cy: py, r: chosen ? 7 : 5 }));
    const wide = 6.6 * dot.label.length;
    const atEnd = px + 10 + wide > width - EDGE;
    let ty = py + 4;
    const hit = (t) => taken.some((other) => Math.abs(other[1] - t) < 13 && Math.abs(other[0] - px) < wide + 12);
    while (hit(ty) && ty > 20) ty -= 13;
    taken.push([px, ty]);
    out.append(svg("text", { class: `name${atEnd ? " end" : ""}`, x: atEnd ? px - 10 : px + 10, y: ty }, dot.label));
  });
  const marks = svg("g");
  out.append(marks);
  const words = (k) => {
    const dot = panel.dots[k];
    const part = (name, e) => `${name}: ${e === null ? "not known" : withUnit(e, panel.y)}`;
    return [dot.label, `${panel.x.name}: ${dot.x}`, part("certified error", dot.certified), part("found error", dot.found)].join("\n");
  };
  const mark = (k) => {
    marks.replaceChildren();
    if (k === null) return;
    const [px, py] = place(panel.dots[k]);
    marks.append(svg("circle", { class: "cursor", fill: "none", cx: px, cy: py, r: 11 }));
  };
  const far = (dot, px, py) => Math.hypot(place(dot)[0] - px, place(dot)[1] - py);
  const near = (px, py) => panel.dots.reduce((best, dot, k) => (far(dot, px, py) < far(panel.dots[best], px, py) ? k : best), 0);
  return { svg: out, width, steps: panel.dots.length, start: current, words, mark, place: (k) => place(panel.dots[k]), near, choose };
}
