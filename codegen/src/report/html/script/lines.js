// Curves over one axis.

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
