// The report of drillmbd report --live in headless Chromium: the scene starts in its frame when the reader asks for it, and runs as natively.
// usage: node test_report_live.mjs REPORT.html EXPECTED.json; EXPECTED: {"time", "hash"} of the native library.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [file, expectedFile] = process.argv.slice(2);
const expected = JSON.parse(await readFile(expectedFile, "utf8"));
let browser;
before(async () => (browser = await Browser.start()));
after(() => browser.stop());
const INSIDE = "document.getElementById('live').contentWindow.live";

for (const [name, size] of [["a desktop", [1280, 900, 1, false]], ["a phone", [390, 844, 2, true]]]) {
    test(`the report runs its scene on ${name}`, async () => {
        const page = await browser.open(pathToFileURL(resolve(file)).href, { size });
        await page.until("document.body?.dataset.drawn", 60);
        assert.equal(await page.ask("document.getElementById('live').hidden"), true, "nothing runs before the reader asks for it");
        await page.ask("document.getElementById('start').click()");
        await page.until(`${INSIDE}?.ready && ${INSIDE}.frames > 0`, 60);
        assert.equal(await page.ask("document.getElementById('start').hidden"), true);
        const last = await page.ask(`(async () => { const { live } = document.getElementById('live').contentWindow; live.post("speed", { value: 1e9 });
            let end = live.next(), found; live.go(${expected.time}); while (!(found = await end).failed && found.time < ${expected.time} - 1e-9) end = live.next();
            return { time: found.time, hash: found.hash, failed: found.failed }; })()`);
        assert.deepEqual(last, { time: last.time, hash: expected.hash });
        assert.equal(await page.ask("document.getElementById('live').contentDocument.getElementById('problems').dataset.count"), "0");
        assert.equal(await page.ask("document.getElementById('problems').dataset.count"), "0");
        assert.ok(await page.ask("document.documentElement.scrollWidth <= innerWidth"), "nothing is wider than the window");
        assert.ok(await page.ask("document.getElementById('live').contentDocument.documentElement.scrollWidth <= document.getElementById('live').clientWidth"));
        assert.deepEqual(page.errors, []);
    });
}
