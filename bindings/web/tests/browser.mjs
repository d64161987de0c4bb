// Headless Chromium by its debugging pipe: a page is opened, asked, looked at; errors of its console are kept.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** Share of the pixels of the view that are not white. */
export const INK = `(() => { const c = document.querySelector('#view canvas'), copy = document.createElement('canvas'); copy.width = c.width; copy.height = c.height;
    const pen = copy.getContext('2d'); pen.drawImage(c, 0, 0); const p = pen.getImageData(0, 0, c.width, c.height).data; let ink = 0;
    for (let i = 0; i < p.length; i += 4) if (p[i + 3] && p[i] + p[i + 1] + p[i + 2] < 740) ink += 1; return ink / (p.length / 4); })()`;

export class Browser {
    static async start(more = []) {
        const made = new Browser();
        made.profile = mkdtempSync(join(tmpdir(), "drillmbd-browser-"));
        made.process = spawn("chromium", ["--headless=new", "--no-sandbox", "--remote-debugging-pipe", "--mute-audio", "--hide-scrollbars", "--no-first-run",
            "--disable-background-networking", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", `--user-data-dir=${made.profile}`, ...more],
            { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
        Object.assign(made, { number: 0, waiting: new Map(), listeners: [], left: "" });
        made.process.stdio[4].on("data", (data) => made.take(data.toString()));
        return made;
    }

    take(text) {
        const parts = (this.left + text).split("\0");
        this.left = parts.pop();
        for (const one of parts) {
            const message = JSON.parse(one), waiting = this.waiting.get(message.id);
            if (waiting) {
                this.waiting.delete(message.id);
                if (message.error) waiting.reject(new Error(message.error.message));
                else waiting.resolve(message.result);
            } else {
                for (const listener of this.listeners) listener(message);
            }
        }
    }

    send(method, params = {}, sessionId = undefined) {
        const id = ++this.number;
        this.process.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
        return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
    }

    /** A page at an address. size: [width, height, scale, phone]. before: script that runs before those of the page. */
    async open(url, { size = [1280, 800, 1, false], before = "" } = {}) {
        const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
        const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
        const page = new Page(this, sessionId, targetId);
        this.listeners.push((message) => message.sessionId === sessionId && page.event(message));
        for (const name of ["Runtime", "Page", "Log"]) await page.send(`${name}.enable`);
        await page.resize(...size);
        if (before) await page.send("Page.addScriptToEvaluateOnNewDocument", { source: before });
        await page.send("Page.navigate", { url });
        return page;
    }

    async stop() {
        const ended = new Promise((resolve) => this.process.once("exit", resolve));
        this.send("Browser.close").catch(() => {});
        await Promise.race([ended, new Promise((resolve) => setTimeout(resolve, 5000))]);
        this.process.kill("SIGKILL");
        rmSync(this.profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
    }
}

class Page {
    constructor(browser, sessionId, targetId) {
        Object.assign(this, { browser, sessionId, targetId, errors: [] });
    }

    send(method, params) {
        return this.browser.send(method, params, this.sessionId);
    }

    event({ method, params }) {
        if (method === "Runtime.exceptionThrown") this.errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
        if (method === "Runtime.consoleAPICalled" && ["error", "warning", "assert"].includes(params.type)) this.errors.push(params.args.map((one) => one.value ?? one.description).join(" "));
        if (method === "Log.entryAdded" && params.entry.level === "error") this.errors.push(params.entry.text);
    }

    async resize(width, height, scale, phone) {
        await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: scale, mobile: phone });
        if (phone) await this.send("Emulation.setTouchEmulationEnabled", { enabled: true });
    }

    /** The value of an expression, awaited. */
    async ask(expression) {
        const { result, exceptionDetails } = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
        if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
        return result.value;
    }

    /** Waits until an expression is true. */
    async until(expression, seconds = 120) {
        const end = Date.now() + 1000 * seconds;
        while (!(await this.ask(`Boolean(${expression})`))) {
            if (Date.now() > end) throw new Error(`not within ${seconds} s: ${expression}; page: ${await this.ask("document.getElementById('message')?.textContent")}; ${this.errors}`);
            await new Promise((resolve) => setTimeout(resolve, 50));
        }
    }

    async key(key) {
        const text = key.length === 1 ? key : undefined;
        await this.send("Input.dispatchKeyEvent", { type: text ? "keyDown" : "rawKeyDown", key, text });
        await this.send("Input.dispatchKeyEvent", { type: "keyUp", key });
    }

    async shot(whole = false) {
        const { data } = await this.send("Page.captureScreenshot", { format: "png", captureBeyondViewport: whole });
        return Buffer.from(data, "base64");
    }
}
