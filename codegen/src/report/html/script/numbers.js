// Numbers for people, and scales with their ticks.

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
