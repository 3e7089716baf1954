"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const SVG = document.querySelector("svg").namespaceURI;
  const tip = document.getElementById("tip");
  let current = data.own;

  // Elements.

  function put(node, attributes, children) {
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...children);
    return node;
  }
  const html = (tag, attributes = {}, ...children) => put(document.createElement(tag), attributes, children);
  const svg = (tag, attributes = {}, ...children) => put(document.createElementNS(SVG, tag), attributes, children);
  const style = (role) => (typeof role === "number" ? `j${role % 8}` : role);

  // Numbers.

  function digits(x) {
    if (x === null || x === undefined) return "none";
    const size = Math.abs(x);
    if (size !== 0 && (size < 1e-3 || size >= 1e6)) return x.toExponential(2).replace("-", "−").replace("e−", "e-");
    const text = size >= 1000 ? String(Math.round(x)) : String(Number(x.toPrecision(4)));
    return text.replace("-", "−");
  }
  const three = (x) => (Math.abs(x) >= 1e-3 && Math.abs(x) < 1000 ? String(Number(x.toPrecision(3))).replace("-", "−") : digits(x));
  const withUnit = (x, axis) => (axis.unit ? `${digits(x)} ${axis.unit}` : digits(x));
  const named = (axis) => (axis.unit ? `${axis.name} (${axis.unit})` : axis.name);

  function niceTicks(low, high, wanted) {
    const raw = (high - low) / wanted;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((k) => k * power).find((k) => k >= raw * 0.999);
    const out = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) out.push(Number((k * step).toPrecision(12)));
    return out;
  }
  function decades(low, high, wanted) {
    if (high - low < 2) {
      const parts = high - low < 1 ? [1, 2, 3, 5, 7] : [1, 2, 5];
      const all = [];
      for (let k = Math.floor(low); k <= high; k++) for (const part of parts) all.push(Number((part * 10 ** k).toPrecision(3)));
      return all.filter((x) => x >= 10 ** (low - 1e-9) && x <= 10 ** (high + 1e-9));
    }
    const [from, to] = [Math.ceil(low - 1e-9), Math.floor(high + 1e-9)];
    const every = Math.max(1, Math.ceil((to - from + 1) / wanted));
    const out = [];
    for (let k = from; k <= to; k += every) out.push(10 ** k);
    return out;
  }

  /** A map from numbers to pixels along one side of a plot, with its ticks. */
  function scale(values, axis, [from, to], wanted, tight = false) {
    const least = axis.least ?? 0;
    let finite = values.filter((x) => x !== null && Number.isFinite(x) && (!axis.logarithmic || x > 0 || least > 0)).map((x) => (axis.logarithmic ? Math.max(x, least) : x));
    if (finite.length === 0) finite = [axis.logarithmic ? 1 : 0, 1];
    let low = finite.reduce((a, b) => Math.min(a, b));
    let high = finite.reduce((a, b) => Math.max(a, b));
    if (axis.logarithmic) {
      low = Math.log10(Math.max(low, high * 1e-10));
      high = Math.log10(high);
      if (high - low < 0.6) [low, high] = [(low + high) / 2 - 0.3, (low + high) / 2 + 0.3];
      if (!tight) [low, high] = [low - 0.06 * (high - low), high + 0.06 * (high - low)];
    } else {
      if (high === low) [low, high] = [low - Math.max(Math.abs(low) / 2, 1e-3), high + Math.max(Math.abs(high) / 2, 1e-3)];
      if (!tight) [low, high] = [low - 0.06 * (high - low), high + 0.06 * (high - low)];
    }
    const at = (x) => {
      const u = axis.logarithmic ? Math.log10(Math.max(x, 10 ** low)) : x;
      return from + ((to - from) * (u - low)) / (high - low);
    };
    const back = (p) => {
      const u = low + ((high - low) * (p - from)) / (to - from);
      return axis.logarithmic ? 10 ** u : u;
    };
    const ticks = axis.logarithmic ? decades(low, high, wanted) : niceTicks(low, high, wanted);
    return { at, back, ticks, low: axis.logarithmic ? 10 ** low : low };
  }
  const tick = (x, axis) => {
    if (!axis.logarithmic) return digits(x);
    if (x >= 1e-3 && x < 1e5) return digits(x);
    return x.toExponential(0).replace("e+", "e");
  };

  // The cursor: one way for a pointer, one for the keyboard and for screen readers.

  function showTip(x, y, text) {
    tip.textContent = text;
    tip.hidden = false;
    const box = tip.getBoundingClientRect();
    const left = x + 14 + box.width > innerWidth ? x - box.width - 14 : x + 14;
    tip.style.left = `${Math.max(4, left)}px`;
    tip.style.top = `${Math.max(4, Math.min(y + 14, innerHeight - box.height - 4))}px`;
  }
  function hideTip() {
    tip.hidden = true;
  }

  /** A plot that can be pointed at and walked through: `picture` has svg, steps, words(k), mark(k), place(k), near(x, y). */
  function plot(label, picture) {
    const input = html("input", { type: "range", min: 0, max: Math.max(picture.steps - 1, 0), step: 1, value: picture.start ?? 0 });
    input.setAttribute("aria-label", `${label}: values`);
    const box = html("div", { class: "plot" }, picture.svg, input);
    picture.svg.setAttribute("aria-hidden", "true");
    const say = (k) => input.setAttribute("aria-valuetext", picture.words(k).replaceAll("\n", ", "));
    const go = (k, x, y) => {
      picture.mark(k);
      showTip(x, y, picture.words(k));
    };
    const byKey = () => {
      const k = Number(input.value);
      const frame = picture.svg.getBoundingClientRect();
      const [x, y] = picture.place(k);
      const zoom = frame.width / picture.width;
      say(k);
      go(k, frame.left + x * zoom, frame.top + y * zoom);
    };
    say(Number(input.value));
    input.addEventListener("input", byKey);
    input.addEventListener("focus", byKey);
    const leave = () => {
      picture.mark(null);
      hideTip();
    };
    input.addEventListener("blur", leave);
    picture.svg.addEventListener("pointermove", (event) => {
      const frame = picture.svg.getBoundingClientRect();
      const zoom = picture.width / frame.width;
      const k = picture.near((event.clientX - frame.left) * zoom, (event.clientY - frame.top) * zoom);
      input.value = k;
      say(k);
      go(k, event.clientX, event.clientY);
    });
    picture.svg.addEventListener("pointerleave", leave);
    if (picture.choose) {
      picture.svg.addEventListener("click", () => picture.choose(Number(input.value)));
      input.addEventListener("keydown", (event) => {
        if (event.key === "Enter") picture.choose(Number(input.value));
      });
    }
    return box;
  }

  // Drawing.

  const EDGE = 18;
  const LOW = 220;
  const TALL = 320;
  const STEPS = 101;

  function frame(width, height, x, y, left, bottom) {
    const out = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "drawing" });
    for (const value of y.scale.ticks) {
      const at = y.scale.at(value);
      out.append(svg("line", { class: "grid", x1: left, x2: width - EDGE, y1: at, y2: at }));
      out.append(svg("text", { class: "end", x: left - 6, y: at + 4 }, tick(value, y.axis)));
    }
    for (const value of x.scale.ticks) {
      const at = x.scale.at(value);
      out.append(svg("line", { class: "axis", x1: at, x2: at, y1: bottom, y2: bottom + 4 }));
      out.append(svg("text", { class: "middle", x: at, y: bottom + 17 }, tick(value, x.axis)));
    }
    out.append(svg("line", { class: "axis", x1: left, x2: width - EDGE, y1: bottom, y2: bottom }));
    out.append(svg("text", { class: "middle", x: (left + width - EDGE) / 2, y: height - 3 }, named(x.axis)));
    const middle = (8 + bottom) / 2;
    out.append(svg("text", { class: "middle", transform: `translate(13 ${middle}) rotate(-90)` }, named(y.axis)));
    return out;
  }

  function path(series, x, y) {
    let pen = "M";
    let out = "";
    series.x.forEach((value, k) => {
      if (series.y[k] === null) {
        pen = "M";
        return;
      }
      out += `${pen}${x.at(value).toFixed(1)} ${y.at(series.y[k]).toFixed(1)}`;
      pen = "L";
    });
    if (series.low) {
      for (let k = series.x.length - 1; k >= 0; k--) out += `L${x.at(series.x[k]).toFixed(1)} ${y.at(series.low[k]).toFixed(1)}`;
      out += "Z";
    }
    return out;
  }

  /** The height of a curve at `x`, between its points; null outside them. */
  function heightAt(xs, ys, x) {
    if (xs.length === 0 || x < xs[0] - 1e-12 || x > xs[xs.length - 1] * (1 + 1e-9) + 1e-12) return null;
    let [a, b] = [0, xs.length - 1];
    while (b - a > 1) {
      const m = (a + b) >> 1;
      if (xs[m] <= x) a = m;
      else b = m;
    }
    if (ys[a] === null || ys[b] === null || xs[b] === xs[a]) return ys[a];
    return ys[a] + ((ys[b] - ys[a]) * Math.min(x - xs[a], xs[b] - xs[a])) / (xs[b] - xs[a]);
  }

  function lines(panel, width, figure) {
    // As high as what stands beside it.
    const HEIGHT = figure.panels.some((other) => other.kind === "dots") ? TALL : LOW;
    const [left, bottom] = [62, HEIGHT - 38];
    const x = scale(panel.series.flatMap((s) => s.x), panel.x, [left, width - EDGE], width / 80, !panel.x.logarithmic);
    const y = scale(panel.series.flatMap((s) => s.y.concat(s.low ?? [])), panel.y, [bottom, 8], 5);
    const out = frame(width, HEIGHT, { scale: x, axis: panel.x }, { scale: y, axis: panel.y }, left, bottom);
    for (const series of panel.series) {
      const kind = series.low ? "band" : "curve";
      out.append(svg("path", { class: `${kind} ${style(series.role)}`, d: path(series, x, y) }));
      if (series.x.length < 20 && panel.x.logarithmic) {
        series.x.forEach((value, k) => out.append(svg("circle", { class: `dot ${style(series.role)}`, cx: x.at(value), cy: y.at(series.y[k]), r: 3 })));
      }
    }
    const marks = svg("g");
    out.append(marks);
    // Few points are walked through one by one, a curve in even steps.
    const own = [...new Set(panel.series.flatMap((s) => s.x))].sort((a, b) => a - b);
    const stops = panel.x.logarithmic ? own : Array.from({ length: STEPS }, (_, k) => x.back(left + ((width - EDGE - left) * k) / (STEPS - 1)));
    const words = (k) => {
      const rows = [`${panel.x.name} ${withUnit(stops[k], panel.x)}`];
      for (const series of panel.series) {
        const high = heightAt(series.x, series.y, stops[k]);
        if (high === null) continue;
        const low = series.low ? `${digits(heightAt(series.x, series.low, stops[k]))} to ` : "";
        rows.push(`${series.name}: ${low}${withUnit(high, panel.y)}`);
      }
      return rows.join("\n");
    };
    const mark = (k) => {
      marks.replaceChildren();
      if (k === null) return;
      const at = x.at(stops[k]);
      marks.append(svg("line", { class: "cursor", x1: at, x2: at, y1: 8, y2: bottom }));
      for (const series of panel.series) {
        const high = heightAt(series.x, series.y, stops[k]);
        if (high !== null) marks.append(svg("circle", { class: `fill ${style(series.role)}`, cx: at, cy: y.at(high), r: 3.5 }));
      }
    };
    const near = (px) => stops.reduce((best, stop, k) => (Math.abs(x.at(stop) - px) < Math.abs(x.at(stops[best]) - px) ? k : best), 0);
    return { svg: out, width, steps: stops.length, words, mark, place: (k) => [x.at(stops[k]), 20], near };
  }

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

  // What differs between two modules.

  /** Pairs of lines that stand in both lists in this order, by lines that are in each of them once. */
  function pairs(a, b, a0, a1, b0, b1, out) {
    while (a0 < a1 && b0 < b1 && a[a0] === b[b0]) out.push([a0++, b0++]);
    const tail = [];
    while (a0 < a1 && b0 < b1 && a[a1 - 1] === b[b1 - 1]) tail.push([--a1, --b1]);
    if (a0 < a1 && b0 < b1) {
      const places = new Map();
      const see = (list, from, to, side) => {
        for (let k = from; k < to; k++) {
          const seen = places.get(list[k]) ?? [[], []];
          seen[side].push(k);
          places.set(list[k], seen);
        }
      };
      see(a, a0, a1, 0);
      see(b, b0, b1, 1);
      const unique = [...places.values()].filter(([p, q]) => p.length === 1 && q.length === 1).map(([p, q]) => [p[0], q[0]]);
      unique.sort((p, q) => p[0] - q[0]);
      const ends = [];
      const before = new Map();
      for (const pair of unique) {
        let k = ends.findIndex((end) => end[1] > pair[1]);
        if (k < 0) k = ends.length;
        ends[k] = pair;
        before.set(pair, k > 0 ? ends[k - 1] : null);
      }
      const chain = [];
      for (let pair = ends[ends.length - 1] ?? null; pair; pair = before.get(pair)) chain.unshift(pair);
      let [i, j] = [a0, b0];
      for (const [p, q] of chain) {
        pairs(a, b, i, p, j, q, out);
        out.push([p, q]);
        [i, j] = [p + 1, q + 1];
      }
      if (chain.length > 0) pairs(a, b, i, a1, j, b1, out);
    }
    out.push(...tail.reverse());
  }

  const CONTEXT = 3;
  const MOST_ROWS = 1500;

  function differenceRows(from, to) {
    const same = [];
    pairs(from, to, 0, from.length, 0, to.length, same);
    same.push([from.length, to.length]);
    const rows = [];
    let [i, j] = [0, 0];
    for (const [p, q] of same) {
      for (; i < p; i++) rows.push(["drop", "−", from[i]]);
      for (; j < q; j++) rows.push(["add", "+", to[j]]);
      if (p < from.length) rows.push(["same", " ", to[q]]);
      [i, j] = [p + 1, q + 1];
    }
    return rows;
  }

  function differenceView(from, to) {
    const rows = differenceRows(from, to);
    const changed = rows.map((row) => row[0] !== "same");
    const near = rows.map((_, k) => changed.slice(Math.max(0, k - CONTEXT), k + CONTEXT + 1).includes(true));
    // A gap of a line or two takes as much room as the lines.
    for (let k = 1; k + 2 < near.length; k++) {
      if (near[k - 1] && !near[k] && (near[k + 1] || near[k + 2])) near[k] = true;
    }
    const out = html("section", { class: "code", tabindex: "0", "aria-label": "Difference of the modules" });
    let hidden = 0;
    let shown = 0;
    const flush = () => {
      if (hidden > 0) out.append(html("span", { class: "gap" }, `${hidden} equal lines`));
      hidden = 0;
    };
    rows.forEach(([kind, sign, line], k) => {
      if (!near[k]) hidden++;
      else if (shown < MOST_ROWS) {
        flush();
        out.append(html("span", { class: kind }, `${sign} ${data.lines[line]}`));
        shown++;
      }
    });
    flush();
    const count = (kind) => rows.filter((row) => row[0] === kind).length;
    const cut = shown >= MOST_ROWS ? `; only the first ${MOST_ROWS} rows are shown` : "";
    return [`${count("add")} lines more, ${count("drop")} lines fewer${cut}`, out];
  }

  let other = -1;
  function fillCode() {
    const box = document.getElementById("difference");
    const state = `${current} ${other}`;
    if (box.dataset.state === state) return;
    box.dataset.state = state;
    const own = data.modules[current];
    const select = html("select", { id: "other" }, html("option", { value: -1 }, "nothing: show the whole module"));
    data.sizes.forEach((size, k) => {
      if (k !== current && data.modules[k]) select.append(html("option", { value: k }, size.label));
    });
    const base = other !== current && other >= 0 && data.modules[other] ? other : -1;
    select.value = String(base);
    select.addEventListener("change", () => {
      other = Number(select.value);
      fillCode();
      document.getElementById("other").focus();
    });
    const words = html("span", { "aria-live": "polite" });
    const pick = html("div", { class: "pick" }, html("label", { for: "other" }, `${data.sizes[current].label}, compared with`), select, words);
    if (!own) {
      box.replaceChildren(html("p", {}, "The module of this size is too long for this page. Write it with gramforge generate."));
      return;
    }
    if (base < 0) {
      const code = html("section", { class: "code", tabindex: "0", "aria-label": "Module" });
      for (const line of own.slice(0, MOST_ROWS)) code.append(html("span", {}, data.lines[line] || " "));
      words.textContent = own.length > MOST_ROWS ? `the first ${MOST_ROWS} of ${own.length} lines` : `${own.length} lines`;
      box.replaceChildren(pick, code);
      return;
    }
    const [told, view] = differenceView(data.modules[base], own);
    words.textContent = told;
    box.replaceChildren(pick, view);
  }

  // The slider.

  const slider = document.getElementById("size");

  function fillAll() {
    hideTip();
    document.querySelectorAll("figure[data-figure]").forEach(fill);
    document.querySelectorAll("nav a").forEach((link) => {
      const target = document.getElementById(link.getAttribute("href").slice(1));
      link.parentElement.hidden = target.hidden;
    });
    fillCode();
  }

  function choose(k) {
    // The new size is compared with the one before, so that the difference of the code shows.
    if (k !== current) other = current;
    current = k;
    if (slider) {
      slider.value = String(k);
      slider.setAttribute("aria-valuetext", data.sizes[k].label);
      document.getElementById("size-name").textContent = data.sizes[k].label;
    }
    fillAll();
  }

  if (slider) slider.addEventListener("input", () => choose(Number(slider.value)));
  let waiting = 0;
  let wide = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === wide) return;
    wide = innerWidth;
    cancelAnimationFrame(waiting);
    waiting = requestAnimationFrame(fillAll);
  });
  choose(current);
})();
