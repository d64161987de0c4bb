// The live page in headless Chromium: no error of its console, pictures drawn, the run of the command with the same hash, what a reader does
// with sliders, keys and buttons, and what the page says where something is missing or fails.
// usage: node test_live.mjs PAGE.html EXPECTED.json LOG.json; EXPECTED: {"time", "torque", "thrust", "hash"} of the native library; the log
// that the page saves is written to LOG.json.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [file, expectedFile, logFile] = process.argv.slice(2);
const url = pathToFileURL(resolve(file)).href;
const expected = JSON.parse(await readFile(expectedFile, "utf8"));
const PHONE = [390, 844, 2, true];
let browser;
before(async () => (browser = await Browser.start()));
after(() => browser.stop());

async function ready(options = {}, address = url) {
    const page = await browser.open(address, options);
    await page.until("window.live?.ready && live.frames > 0", 60);
    return page;
}

/** Runs a ready page to a time, as fast as it goes; the last frame. */
async function runTo(page, time) {
    await page.ask("live.post('speed', {value: 1e9})");
    return page.ask(`(async () => { let end = live.next(), found; live.go(${time});
        while (!(found = await end).failed && found.time < ${time} - 1e-9) end = live.next(); // pictures of before the run may come first
        const {base, offset, turn, force, ...last} = found; return last; })()`);
}

/** Share of the pixels of the view that are not white. */
const INK = `(() => { const c = document.querySelector('#view canvas'), copy = document.createElement('canvas'); copy.width = c.width; copy.height = c.height;
    const pen = copy.getContext('2d'); pen.drawImage(c, 0, 0); const p = pen.getImageData(0, 0, c.width, c.height).data; let ink = 0;
    for (let i = 0; i < p.length; i += 4) if (p[i + 3] && p[i] + p[i + 1] + p[i + 2] < 740) ink += 1; return ink / (p.length / 4); })()`;

async function quiet(page) {
    assert.deepEqual(page.errors, []);
    assert.equal(await page.ask("document.getElementById('problems').dataset.count"), "0");
}

for (const [name, size, address] of [["a desktop", [1400, 900, 1, false], url], ["a phone", PHONE, url], ["a browser without WebGL", [1400, 900, 1, false], `${url}#2d`]]) {
    test(`the run of the command on ${name}: torque, thrust and hash`, async () => {
        const page = await ready({ size }, address);
        assert.equal(await page.ask("live.lanes"), 2, "SIMD is used");
        const last = await runTo(page, expected.time);
        assert.ok(Math.abs(last.time - expected.time) < 1e-9);
        assert.equal(last.values[0], expected.torque);
        assert.equal(last.values[1], expected.thrust);
        assert.equal(last.hash, expected.hash);
        await page.until("live.frames > 3");
        const ink = await page.ask(INK);
        assert.ok(ink > 0.01 && ink < 0.6, `${ink} of the view is drawn`);
        assert.ok((await page.ask("live.traces.every((one) => one.rows.length > 50)")), "traces have rows");
        assert.ok((await page.ask("document.documentElement.scrollWidth <= innerWidth")), "nothing is wider than the window");
        await quiet(page);
    });
}

for (const [name, flags, before] of [["without SIMD", ["--js-flags=--no-enable-sse4-1"], ""], ["that cannot unpack", [], "delete globalThis.DecompressionStream"]]) {
    test(`a browser ${name} computes the same run with the library for all browsers`, async () => {
        const other = flags.length ? await Browser.start(flags) : browser;
        try {
            const page = await other.open(url, { before });
            await page.until("window.live?.ready && live.frames > 0", 60);
            assert.equal(await page.ask("live.lanes"), 1);
            assert.equal((await runTo(page, expected.time)).hash, expected.hash);
            await quiet(page);
        } finally {
            if (other !== browser) await other.stop();
        }
    });
}

test("keys run, stop, step, keep, restore and reset", async () => {
    const page = await ready();
    await page.key(" ");
    await page.until("live.last.time > 0.1 && live.running");
    await page.key(" ");
    await page.until("!live.running && live.last.hash");
    const { hash, time } = await page.ask("({hash: live.last.hash, time: live.last.time})");
    await page.key("k");
    await page.until("live.last.kept !== null");
    await page.key("s");
    await page.until(`live.last.time > ${time}`);
    assert.notEqual(await page.ask("live.last.hash"), hash);
    await page.key("l");
    await page.until(`live.last.hash === "${hash}"`);
    await page.key("r");
    await page.until("live.last.time === 0");
    const { turn } = await page.ask("({turn: live.view.camera.turn})");
    await page.key("ArrowLeft");
    assert.notEqual(await page.ask("live.view.camera.turn"), turn);
    await quiet(page);
});

test("the page never waits for the computation", async () => {
    const page = await ready();
    await page.ask("live.post('speed', {value: 1e9})");
    await page.ask("live.go()");
    // Half of the frames come within 500 ms, on a machine of two busy cores without graphics too.
    const gaps = await page.ask(`new Promise((resolve) => { let before = performance.now(); const gaps = [];
        const look = () => { const now = performance.now(); gaps.push(now - before); before = now; if (gaps.length < 40) requestAnimationFrame(look); else resolve(gaps); };
        requestAnimationFrame(look); })`);
    const median = gaps.sort((a, b) => a - b)[20];
    assert.ok(median < 500, `${median} ms between two frames`);
    await quiet(page);
});

test("a slider moves an input, and the saved log has it", async () => {
    const page = await ready();
    await runTo(page, 0.5);
    await page.ask(`(() => { const at = live.record.controls.findIndex((one) => one.name === "rotation"), {range} = live.inputs[at];
        range.value = 60; range.dispatchEvent(new Event("input")); })()`);
    await page.until("live.last.log === 1");
    await runTo(page, 1.0);
    await page.ask(`(() => { const at = live.record.controls.findIndex((one) => one.name === "friction"), {range} = live.inputs[at];
        range.value = 1.5; range.dispatchEvent(new Event("input")); })()`);
    await page.until("live.last.log === 2");
    await runTo(page, 1.6);
    const log = await page.ask("(async () => { const made = live.next(); document.getElementById('save').click(); return made; })()");
    assert.equal(log.inputs.length, 2);
    assert.ok(Math.abs(log.inputs[0].value - 2 * Math.PI) < 1e-3 && Math.abs(log.inputs[0].time - 0.5) < 1e-9);
    writeFileSync(logFile, JSON.stringify(log));
    await quiet(page);
});

test("another diameter of the hole begins the scene anew; one that the string does not fit is refused and the old one goes on", async () => {
    const page = await ready();
    await runTo(page, 0.1);
    const diameter = await page.ask("live.diameter");
    await page.ask(`live.post("rebuild", {diameter: ${1.2 * diameter}})`);
    await page.until(`live.diameter > ${1.1 * diameter} && live.last.time === 0`);
    await page.ask("live.post('rebuild', {diameter: 0.01})");
    await page.until("document.getElementById('message').hidden === false");
    assert.match(await page.ask("document.getElementById('message').textContent"), /could not start.*\n.*continues/s);
    const last = await runTo(page, 0.1);
    assert.ok(Math.abs(last.time - 0.1) < 1e-9);
    await quiet(page);
});

test("a step that fails is said in the page, and the state before it is kept", async () => {
    const page = await ready();
    await runTo(page, 0.1);
    const hash = await page.ask("live.last.hash");
    await page.ask("live.post('set', {number: 0, value: 1e30})");
    await page.until("/Failed at 0.100 s/.test(document.getElementById('message').textContent)");
    assert.match(await page.ask("document.getElementById('message').textContent"), /must be.*\n.*state is kept/s);
    assert.ok(hash);
    const last = await runTo(page, 0.2);
    assert.ok(Math.abs(last.time - 0.2) < 1e-9);
    await quiet(page);
});

test("without WebAssembly and without enough memory the page says so", async () => {
    const page = await browser.open(url, { before: "delete globalThis.WebAssembly" });
    await page.until("document.getElementById('message')?.hidden === false");
    assert.match(await page.ask("document.getElementById('message').textContent"), /no WebAssembly/);
    const long = (await readFile(file, "utf8")).replace(/(id="scene">)(.*?)(<\/script>)/s, (_, head, text, tail) => { // a thousand times as many pipes
        const record = JSON.parse(text);
        for (const call of record.calls) if (call[0] === "add_pipes") call[2] *= 1000;
        return head + JSON.stringify(record).replaceAll("<", "\\u003c") + tail;
    });
    const longFile = `${file}.long.html`;
    writeFileSync(longFile, long);
    const small = await browser.open(`${pathToFileURL(resolve(longFile)).href}#memory=16`);
    await small.until("document.getElementById('message')?.hidden === false", 60);
    assert.match(await small.ask("document.getElementById('message').textContent"), /could not start: .*memory.*\n.*cannot run in this browser/s);
    await quiet(page);
    await quiet(small);
});
