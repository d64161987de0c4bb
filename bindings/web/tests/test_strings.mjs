// Pages of scenes with several strings in headless Chromium: the native run, strings that continue each other joined and others apart, in
// WebGL and in lines, on a desktop and a phone, without an error of the console.
// usage: node test_strings.mjs PAGE.html EXPECTED.json STRINGS APART ...: STRINGS of the scene, of which APART continue no other.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { basename, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser, INK } from "./browser.mjs";

const given = process.argv.slice(2);
let browser;
before(async () => (browser = await Browser.start()));
after(() => browser.stop());

for (let k = 0; k < given.length; k += 4) {
    const [file, expectedFile, strings, apart] = [given[k], given[k + 1], Number(given[k + 2]), Number(given[k + 3])];
    for (const [name, size, lines] of [["a desktop", [1400, 900, 1, false], ""], ["a phone", [390, 844, 2, true], ""], ["a desktop in lines", [1400, 900, 1, false], "#2d"]]) {
        test(`${basename(file, ".html")} on ${name}: the native run, ${strings} strings, ${apart} of them apart`, async () => {
            const expected = JSON.parse(await readFile(expectedFile, "utf8"));
            const page = await browser.open(pathToFileURL(resolve(file)).href + lines, { size });
            await page.until("window.live?.ready && live.frames > 0", 60);
            await page.ask("live.post('speed', {value: 1e9})");
            const last = await page.ask(`(async () => { let end = live.next(), found; live.go(${expected.time});
                while (!(found = await end).failed && found.time < ${expected.time} - 1e-9) end = live.next(); return { hash: found.hash, values: found.values }; })()`);
            assert.equal(last.hash, expected.hash);
            assert.equal(last.values.length, expected.values.length);
            last.values.forEach((value, i) => assert.ok(Math.abs(value - expected.values[i]) <= 1e-8 * Math.max(1, Math.abs(expected.values[i])), `${last.values} for ${expected.values}`));
            const found = await page.ask(`({rings: live.view.rings.length, begins: live.view.rings.filter((one) => one.before < 0).length, ends: live.view.lasts.length,
                gaps: live.view.line.filter((one) => one.gap).length, hole: live.view.line[0].radius > 0, triangles: live.view.gl ? live.view.index() / 6 / 14 : null})`);
            assert.equal(found.ends, strings);
            assert.equal(found.begins, apart);
            assert.equal(found.gaps, found.hole ? 0 : apart - 1, "the reference line of a scene without hole has a gap before each string that lies apart");
            if (!lines) assert.equal(found.triangles, found.rings - apart, "each ring is joined to the one before it, but for those where strings begin");
            for (const look of ["whole", "rig", "bit"]) {
                await page.ask(`document.querySelector('[data-look=${look}]').click()`);
                await page.ask("new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))");
                const ink = await page.ask(INK);
                assert.ok(ink > (found.hole ? 0.01 : 0.0003) && ink < 0.6, `${ink} of the view at ${look} is drawn`);
            }
            assert.ok((await page.ask("live.frames")) > 3, "pictures are drawn");
            assert.ok((await page.ask("document.documentElement.scrollWidth <= innerWidth")), "nothing is wider than the window");
            assert.deepEqual(page.errors, []);
            assert.equal(await page.ask("document.getElementById('problems').dataset.count"), "0");
        });
    }
}
