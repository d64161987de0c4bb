// Pictures of a live page for the eye: usage: node shot.mjs PAGE.html FOLDER [SECONDS of the run, default 4]
import { writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [file, folder, seconds = "4"] = process.argv.slice(2);
const browser = await Browser.start();
for (const [name, size, more] of [["desktop", [1400, 900, 1, false]], ["phone", [390, 844, 2, true]], ["bit", [1400, 900, 1, false], "bit"], ["flat", [1400, 900, 1, false]]]) {
    const page = await browser.open(pathToFileURL(resolve(file)) + (name === "flat" ? "#2d" : ""), { size });
    await page.until("window.live?.ready", 60);
    await page.ask("live.post('speed', {value: 1e9})");
    await page.ask(`(async () => { const end = live.next(); live.go(${seconds}); await end; })()`);
    if (more) await page.ask(`document.querySelector('[data-look=${more}]').click()`);
    await page.ask("new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))");
    writeFileSync(join(folder, `${name}.png`), await page.shot(name === "phone"));
    console.log(name, page.errors, await page.ask("live.last.hash"), await page.ask("document.getElementById('message').textContent"), await page.ask("document.documentElement.scrollWidth"));
}
await browser.stop();
