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
import { Browser, INK } from "./browser.mjs";

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

async function quiet(page) {
    assert.deepEqual(page.errors, []);
    assert.equal(await page.ask("document.getElementById('problems').dataset.count"), "0");
}

for (const [name, size, address] of [["a desktop", [1400, 900, 1, false], url], ["a phone", PHONE, url], ["a desktop in lines", [1400, 900, 1, false], `${url}#2d`]]) {
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

test("a browser without WebGL draws lines, says so and computes the same run", async () => {
    const other = await Browser.start(["--disable-gpu", "--disable-3d-apis"]);
    try {
        const page = await other.open(url, { size: [1400, 900, 1, false] });
        await page.until("window.live?.ready && live.frames > 0", 60);
        assert.ok(await page.ask("document.createElement('canvas').getContext('webgl') === null && live.view.gl === null"), "there is none");
        assert.match(await page.ask("document.getElementById('message').textContent"), /no WebGL: .*lines/);
        assert.equal((await runTo(page, expected.time)).hash, expected.hash);
        const ink = await page.ask(INK);
        assert.ok(ink > 0.01 && ink < 0.6, `${ink} of the view is drawn`);
        await page.key("ArrowLeft");
        await quiet(page);
    } finally {
        await other.stop();
    }
});

test("WebGL that a browser takes away and does not give back is replaced by lines, and the run goes on", async () => {
    const page = await ready({ size: [1400, 900, 1, false] });
    await page.ask("live.view.gl.getExtension('WEBGL_lose_context').loseContext()");
    await page.until("live.view.pen");
    assert.match(await page.ask("document.getElementById('message').textContent"), /no WebGL: .*lines/);
    assert.equal((await runTo(page, expected.time)).hash, expected.hash);
    const ink = await page.ask(INK);
    assert.ok(ink > 0.01 && ink < 0.6, `${ink} of the view is drawn`);
    const { x, y, turn } = await page.ask("(() => { const at = live.view.canvas.getBoundingClientRect(); return {x: at.x + 300, y: at.y + 100, turn: live.view.camera.turn}; })()");
    for (const [type, dx] of [["mousePressed", 0], ["mouseMoved", 40], ["mouseReleased", 40]])
        await page.send("Input.dispatchMouseEvent", { type, x: x + dx, y, button: "left", buttons: type === "mouseReleased" ? 0 : 1, clickCount: 1 });
    assert.notEqual(await page.ask("live.view.camera.turn"), turn, "the new canvas turns by the pointer");
    await quiet(page);
});

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

/** [s] of processor time that the thread of the page has used. */
async function ownTime(page) {
    const { metrics } = await page.send("Performance.getMetrics");
    return metrics.find((one) => one.name === "ThreadTime").value;
}

/** [s] of processor time of the page's thread for each of the next 30 pictures. wanted: what makes it draw. */
async function pictureTime(page, wanted) {
    const [from, frames] = [await ownTime(page), await page.ask("live.frames")];
    await page.ask(`new Promise((resolve) => { const look = () => { ${wanted} if (live.frames < ${frames + 30}) requestAnimationFrame(look); else resolve(); }; look(); })`);
    return ((await ownTime(page)) - from) / ((await page.ask("live.frames")) - frames);
}

test("the page never waits for the computation", async () => {
    const page = await ready();
    await page.send("Performance.enable");
    await page.ask("live.post('speed', {value: 1e9})");
    await runTo(page, 0.2);
    // Processor time of the page's own thread, which the load of the machine hardly changes: of a picture while the sim runs as fast as it can, and of
    // the same picture while it stands. A sim in this thread would add at least the 33 ms (FRAME of worker.mjs) between two pictures.
    await page.ask("live.go()");
    const running = await pictureTime(page, "");
    assert.ok((await page.ask("live.running && live.last.time")) > 0.2, "it runs");
    await page.ask("live.go()");
    await page.until("!live.running && live.last.hash");
    const standing = await pictureTime(page, "live.redraw = true;");
    assert.ok(running < 2 * standing + 0.016, `a picture takes ${1e3 * running} ms of the page's thread while the sim runs, ${1e3 * standing} ms while it stands`);
    // The page does its own work while the worker is busy for long, as with a model that is built again.
    const { ticks, during } = await page.ask(`new Promise((resolve) => { const began = performance.now(); let ticks = 0;
        live.ready = false; live.post("reset");
        const tick = () => { if (live.ready) resolve({ ticks, during: performance.now() - began }); else { ticks += 1; setTimeout(tick); } }; tick(); })`);
    assert.ok(ticks >= 5, `${ticks} turns of the page in the ${during} ms of a model that is built`);
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

test("a memory that becomes full during a run is said in the page, the state is kept, and Reset takes a new memory", async () => {
    // A worker that can fill its memory: `room` bytes stay free in one piece, and pieces below `least`.
    const fill = `ANSWERS.fill = ({ least, room }) => { const { library } = state, kept = room ? library._run("malloc", room) : 0;
        for (let size = 2 ** 20; size >= least; size /= 2) while (library._run("malloc", size)) {}
        if (kept) library._run("free", kept); postMessage({ type: "restored", time: time() }); };`;
    const small = `${file}.small.html`;
    writeFileSync(small, (await readFile(file, "utf8")).replace(/(id="worker">.*?)(<\/script>)/s, (_, text, tail) => `${text}\n${fill}\n${tail}`));
    const page = await ready({}, `${pathToFileURL(resolve(small)).href}#memory=64`);
    const message = () => page.ask("document.getElementById('message').textContent");
    await runTo(page, 0.1);
    const hash = await page.ask("live.last.hash");
    await page.ask("live.post('fill', {least: 16384, room: 32768})");
    await page.ask("live.post('keep')");
    await page.until("/Failed at 0.100 s/.test(document.getElementById('message').textContent)");
    assert.match(await message(), /bytes could not be allocated.*\n.*state is kept/s);
    assert.equal(await page.ask("live.last.kept"), null);
    await page.ask("live.post('stop')");
    await page.until("live.last.hash");
    assert.equal(await page.ask("live.last.hash"), hash);
    assert.equal((await runTo(page, expected.time)).hash, expected.hash, "the run goes on");

    await page.ask("live.post('fill', {least: 16})"); // now not even a picture can be made
    await page.ask("live.post('step')");
    await page.until(`/Failed at .*allocated/.test(document.getElementById('message').textContent)`);
    assert.match(await message(), /state is kept: .*reset/s);
    await page.ask("live.post('reset')");
    await page.until("live.last.time === 0 && document.getElementById('message').hidden");
    assert.equal((await runTo(page, expected.time)).hash, expected.hash, "the same run in a new memory");
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
