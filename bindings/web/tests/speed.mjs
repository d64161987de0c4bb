// Real-time factor of live pages in headless Chromium and, with the module alone, in node. usage: node speed.mjs SECONDS PAGE.html...
import { readFile } from "node:fs/promises";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [seconds, ...files] = process.argv.slice(2);
const browser = await Browser.start();
for (const file of files) {
    const page = await browser.open(pathToFileURL(resolve(file)).href);
    await page.until("window.live?.ready", 120);
    await page.ask("live.tell('speed', {value: 1e9})");
    const wall = await page.ask(`(async () => { const began = performance.now(), end = live.next(); live.go(${seconds}); await end; return (performance.now() - began) / 1000; })()`);
    console.log(`${file}: ${(await readFile(file)).length} bytes, ${(seconds / wall).toFixed(2)} times real time in Chromium, ${await page.ask("live.bytes")} bytes of memory`);
}
await browser.stop();
