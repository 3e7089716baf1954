// The arm, seen from three sides.

/** How a point of space stands on paper: from obliquely above, from the side, from above. */
function views(up) {
  const [a, b] = [0, 1, 2].filter((i) => i !== up);
  const [c, s] = [Math.cos(0.6), Math.sin(0.6)];
  const [ce, se] = [Math.cos(0.42), Math.sin(0.42)];
  const axis = "xyz";
  return [
    ["seen obliquely", (p) => [c * p[a] - s * p[b], ce * p[up] + se * (s * p[a] + c * p[b])]],
    [`from the side: ${axis[a]} and ${axis[up]}`, (p) => [p[a], p[up]]],
    [`along ${axis[up]}: ${axis[a]} and ${axis[b]}`, (p) => [p[a], p[b]]],
  ];
}

function arm(panel, width) {
  const narrow = width < 560;
  const shown = views(panel.up).slice(0, narrow ? 1 : 3);
  const height = narrow ? 300 : 340;
  const out = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "drawing" });
  const pose = (k) => {
    const flat = panel.corners[k];
    return Array.from({ length: flat.length / 3 }, (_, i) => flat.slice(3 * i, 3 * i + 3));
  };
  const poses = panel.corners.map((_, k) => pose(k));
  const live = svg("g");
  const each = width / (shown.length === 3 ? 3 : 1);
  const drawers = shown.map(([name, onto], v) => {
    const flat = poses.flat().map(onto);
    const [xs, ys] = [flat.map((p) => p[0]), flat.map((p) => p[1])];
    const ends = (list) => [list.reduce((m, u) => Math.min(m, u)), list.reduce((m, u) => Math.max(m, u))];
    const [[x0, x1], [y0, y1]] = [ends(xs), ends(ys)];
    const zoom = Math.min((each - 40) / Math.max(x1 - x0, 1e-3), (height - 80) / Math.max(y1 - y0, 1e-3));
    const [mx, my] = [each * (v + 0.5), 20 + (height - 80) / 2];
    const at = (p) => {
      const [px, py] = onto(p);
      return [mx + zoom * (px - (x0 + x1) / 2), my - zoom * (py - (y0 + y1) / 2)];
    };
    out.append(svg("text", { class: "middle", x: mx, y: height - 30 }, name));
    // A length to measure by.
    const length = 10 ** Math.floor(Math.log10(Math.max(x1 - x0, y1 - y0, 1e-3)));
    const unit = [1, 0.5, 0.2].map((k) => k * length).find((k) => k * zoom < each / 3) ?? 0.1 * length;
    const [u0, u1] = [mx - (unit * zoom) / 2, mx + (unit * zoom) / 2];
    out.append(svg("path", { class: "link desired", "stroke-width": 1, d: `M${u0} ${height - 20}v4h${u1 - u0}v-4` }));
    out.append(svg("text", { class: "middle", x: mx, y: height - 4 }, `${digits(unit)} m`));
    return at;
  });
  const drawn = (k, role, faint) => {
    const group = svg("g", { class: role, opacity: faint });
    for (const at of drawers) {
      const corners = poses[k].map(at);
      group.append(svg("path", { class: "link", "stroke-width": 5, d: `M${corners.map((p) => p.map((u) => u.toFixed(1)).join(" ")).join("L")}` }));
      const [bx, by] = corners[0];
      group.append(svg("path", { class: "link", "stroke-width": 2, d: `M${bx - 12} ${by + 4}h24` }));
      for (const j of panel.joints) group.append(svg("circle", { class: "dot", cx: corners[j][0].toFixed(1), cy: corners[j][1].toFixed(1), r: 4 }));
      const tipAt = corners[corners.length - 1];
      group.append(svg("circle", { class: "fill", cx: tipAt[0].toFixed(1), cy: tipAt[1].toFixed(1), r: 3 }));
    }
    return group;
  };
  for (const at of drawers) {
    const trail = poses.map((corners) => at(corners[corners.length - 1]).map((u) => u.toFixed(1)).join(" "));
    out.append(svg("path", { class: "curve exact", d: `M${trail.join("L")}` }));
  }
  panel.key.forEach((k, i) => out.append(drawn(k, "certified", (0.15 + (0.75 * i) / Math.max(panel.key.length - 1, 1)).toFixed(2))));
  out.append(live);
  const words = (k) => {
    const p = poses[k][poses[k].length - 1];
    return `time ${digits(panel.time[k])} s\ntip: x ${digits(p[0])} m, y ${digits(p[1])} m, z ${digits(p[2])} m`;
  };
  const mark = (k) => {
    live.replaceChildren();
    if (k !== null) live.append(drawn(k, "found", 1));
  };
  const near = (px) => Math.max(0, Math.min(poses.length - 1, Math.round((poses.length - 1) * ((px % each) / each))));
  return { svg: out, width, steps: poses.length, words, mark, place: () => [30, 10], near };
}
