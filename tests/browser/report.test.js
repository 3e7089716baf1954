// The HTML reports as a person uses them: slider, pointer, keyboard, dark theme, paper; and as checkers see them.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";

import { HtmlValidate, FileSystemConfigLoader } from "html-validate";
import { chromium } from "playwright-core";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const gramforge = process.env.GRAMFORGE ?? join(root, "target/release/gramforge");
const out = join(root, "target/browser");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const validator = new HtmlValidate(new FileSystemConfigLoader({ root: true, extends: ["html-validate:recommended"] }));

const REPORTS = {
  arm3: ["generated/specs/arm3_xi2.json"],
  puma: ["generated/specs/puma560_one_percent.json", "--sizes", "exact,5%", "--runs", "8"],
  // Minutes for each size: one is enough to see seven joints and an arm from a URDF file.
  panda: ["tests/data/panda.json", "--one-size", "--runs", "4"],
};

let browser;

before(async () => {
  mkdirSync(out, { recursive: true });
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
});
after(() => browser?.close());

/** The report, opened, and all that the browser had to say of it. */
async function opened(path, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, colorScheme: "light", ...options });
  const page = await context.newPage();
  const said = [];
  const asked = [];
  page.on("console", (message) => said.push(message.text()));
  page.on("pageerror", (error) => said.push(error.message));
  page.on("request", (request) => asked.push(request.url()));
  const begin = performance.now();
  await page.goto(`file://${path}`);
  const time = performance.now() - begin;
  return { page, said, asked, time, close: () => context.close() };
}

/** What is drawn: by figure the markup of its pictures. */
const drawn = (page) =>
  page.$$eval("figure[data-figure]", (figures) => Object.fromEntries(figures.map((f) => [f.dataset.figure, f.querySelector(".panels").innerHTML])));

async function seriousFindings(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => axe.run());
  const serious = violations.filter((v) => ["serious", "critical"].includes(v.impact));
  return serious.map((v) => `${v.id}: ${v.nodes.map((n) => n.html.slice(0, 120)).join(" | ")}`);
}

const faults = (report) => report.results.flatMap((r) => r.messages).map((m) => `${m.ruleId} ${m.line}:${m.column} ${m.message}`);

for (const [name, [spec, ...options]] of Object.entries(REPORTS)) {
  describe(name, () => {
    const path = join(out, `${name}.html`);
    let sizes;

    before(() => {
      execFileSync(gramforge, ["report", join(root, spec), "--out", path, ...options], { stdio: ["ignore", "pipe", "ignore"] });
      sizes = JSON.parse(readFileSync(path, "utf8").split('id="data">')[1].split("</script>")[0]).sizes;
    });

    test("is one small file that loads nothing and says nothing", async () => {
      const bytes = statSync(path).size;
      assert.ok(bytes < 3e6, `${bytes} bytes`);
      const { page, said, asked, time, close } = await opened(path);
      await page.waitForTimeout(300);
      assert.deepEqual(said, []);
      assert.deepEqual(asked, [`file://${path}`]);
      console.log(`${name}: ${bytes} bytes, ${sizes.length} sizes, opened in ${time.toFixed(0)} ms`);
      await close();
    });

    test("is valid HTML as written and as drawn", async () => {
      const written = await validator.validateString(readFileSync(path, "utf8"));
      assert.deepEqual(faults(written), []);
      const { page, close } = await opened(path);
      const whole = await page.evaluate(() => `<!DOCTYPE html>\n${document.documentElement.outerHTML}`.replaceAll(' hidden=""', " hidden"));
      assert.deepEqual(faults(await validator.validateString(whole)), []);
      await close();
    });

    test("has no serious finding of axe, by day, by night and on a narrow screen", async () => {
      for (const options of [{}, { colorScheme: "dark" }, { viewport: { width: 390, height: 800 } }]) {
        const { page, close } = await opened(path, options);
        assert.deepEqual(await seriousFindings(page), []);
        await close();
      }
    });

    test("tells values to a pointer", async () => {
      const { page, said, close } = await opened(path);
      const tip = page.locator("#tip");
      const plots = page.locator("figure[data-figure] .plot svg.drawing");
      const count = await plots.count();
      assert.ok(count >= 12, `${count} plots`);
      for (let k = 0; k < count; k++) {
        const plot = plots.nth(k);
        await plot.scrollIntoViewIfNeeded();
        const box = await plot.boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        assert.ok(await tip.isVisible());
        assert.match(await tip.textContent(), /\d/);
      }
      await page.mouse.move(2, 2);
      assert.ok(await tip.isHidden());
      assert.deepEqual(said, []);
      await close();
    });

    test("tells values to the keyboard", async () => {
      const { page, close } = await opened(path);
      const plots = page.locator("figure[data-figure] .plot input");
      for (const k of [1, (await plots.count()) - 1]) {
        const plot = plots.nth(k);
        await plot.focus();
        await page.keyboard.press("Home");
        const first = await plot.getAttribute("aria-valuetext");
        await page.keyboard.press("End");
        const last = await plot.getAttribute("aria-valuetext");
        assert.match(first, /\d/);
        assert.notEqual(first, last);
        assert.ok(await page.locator("#tip").isVisible());
        assert.equal((await page.locator("#tip").textContent()).replaceAll("\n", ", "), last);
        const outline = await page.locator(".plot:focus-within").evaluate((node) => getComputedStyle(node).outlineStyle);
        assert.equal(outline, "solid");
      }
      await close();
    });

    test("gives the data of every figure as a file", async () => {
      const { page, close } = await opened(path);
      const figures = await page.locator("figure[data-figure]").count();
      for (const details of await page.locator("details.data").all()) await details.evaluate((node) => (node.open = true));
      await page.waitForFunction((n) => document.querySelectorAll("details.data li").length >= n, figures);
      const links = await page.$$eval("details.data a", (all) => all.map((a) => [a.download, a.href]));
      for (const [file, href] of links) {
        assert.match(file, /\.csv$/);
        const text = decodeURIComponent(href.replace("data:text/csv;charset=utf-8,", ""));
        const rows = text.trimEnd().split("\n");
        assert.ok(rows.length > 1 && /\d/.test(text), `${file}: ${text.slice(0, 80)}`);
      }
      await close();
    });

    test("is dark where the reader wants that, and light on paper", async () => {
      const brightness = (page) =>
        page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).slice(0, 3).reduce((a, b) => a + Number(b), 0));
      const { page, close } = await opened(path, { colorScheme: "dark" });
      assert.ok((await brightness(page)) < 150);
      const curve = () => page.locator(".curve.found, .fill.certified").first().evaluate((node) => getComputedStyle(node).color);
      const dark = await curve();
      await page.emulateMedia({ colorScheme: "light" });
      assert.ok((await brightness(page)) > 700);
      assert.notEqual(await curve(), dark);
      await page.emulateMedia({ colorScheme: "dark", media: "print" });
      assert.ok((await brightness(page)) > 700);
      assert.ok(await page.locator("nav").isHidden());
      const pdf = await page.pdf({ format: "A4" });
      const pages = pdf.toString("latin1").match(/\/Type\s*\/Page\b/g).length;
      assert.ok(pages >= 4 && pages < 60, `${pages} pages`);
      await close();
    });

    test("shows another size, and what differs in its code, when the slider moves", async (t) => {
      if (sizes.length === 1) return t.skip("one size");
      const { page, said, close } = await opened(path);
      const slider = page.locator("#size");
      const seen = [];
      await slider.focus();
      await page.keyboard.press("Home");
      for (let k = 0; k < sizes.length; k++) {
        assert.equal(await page.locator("#size-name").textContent(), sizes[k].label);
        assert.equal(await slider.getAttribute("aria-valuetext"), sizes[k].label);
        seen.push(await drawn(page));
        if (k > 0) assert.match(await page.locator("#difference .pick").textContent(), /\d+ lines more, \d+ lines fewer/);
        await page.keyboard.press("ArrowRight");
      }
      const pictures = (figure) => new Set(seen.map((state) => state[figure])).size;
      for (const figure of ["summary", "sizes", "bounds", "operations"]) assert.equal(pictures(figure), sizes.length, figure);
      for (const figure of ["functions", "funnel", "tracking", "torques", "lyapunov", "gains"]) assert.ok(pictures(figure) > 1, figure);
      // What the sizes share stays as it is.
      for (const figure of ["arm", "motion", "domain"]) assert.equal(pictures(figure), 1, figure);
      assert.ok((await page.locator("#difference .add").count()) > 0 && (await page.locator("#difference .drop").count()) > 0);
      // A dot chooses its size.
      const dots = page.locator('figure[data-figure="sizes"] .plot input').first();
      await dots.focus();
      await page.keyboard.press("Home");
      await page.keyboard.press("Enter");
      assert.equal(await page.locator("#size-name").textContent(), sizes[0].label);
      assert.equal(await slider.inputValue(), "0");
      assert.deepEqual(said, []);
      await close();
    });
  });
}
