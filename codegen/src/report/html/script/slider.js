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
