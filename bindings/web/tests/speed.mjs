// Real-time factor of live pages in headless Chromium, with SIMD and without. usage: node speed.mjs PAGE.html...
import { readFile } from "node:fs/promises";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const files = process.argv.slice(2);
const BEGIN = 1, LENGTH = 0.1, REPEATS = 40; // [s] of the part of the run that is measured, again and again

/** Simulated over clock time, pictures included, of the fastest repetition: of so short a part one is not disturbed by what else runs here. */
async function factor(page) {
    await page.ask("live.post('speed', {value: 1e9})");
    return page.ask(`(async () => {
        const to = async (time) => { let end = live.next(); live.go(time); while ((await end).time < time - 1e-9) end = live.next(); };
        await to(${BEGIN});
        live.post("keep");
        let least = Infinity;
        for (let k = 0; k < ${REPEATS}; k++) {
            const restored = live.next();
            live.post("restore");
            await restored;
            const began = performance.now();
            await to(${BEGIN + LENGTH});
            least = Math.min(least, performance.now() - began);
        }
        return (${1000 * LENGTH} / least).toFixed(2);
    })()`);
}

for (const [name, flags] of [["SIMD", []], ["no SIMD", ["--js-flags=--no-enable-sse4-1"]]]) {
    const browser = await Browser.start(flags);
    for (const file of files) {
        const page = await browser.open(pathToFileURL(resolve(file)).href);
        await page.until("window.live?.ready", 120);
        console.log(`${file}: Chromium, ${name}: ${await factor(page)} times real time; page ${(await readFile(file)).length} bytes, memory ${await page.ask("live.bytes")}, hash ${await page.ask("live.last.hash")}`);
    }
    await browser.stop();
}
