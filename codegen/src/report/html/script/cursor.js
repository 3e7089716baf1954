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
