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
