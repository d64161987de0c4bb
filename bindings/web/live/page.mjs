// The page: buttons, sliders, keys and pointers on one side, messages of the worker on the other.
import { shown, Trace } from "./traces.mjs";
import { View } from "./view.mjs";
import { speak, word } from "./words.mjs";

const SECONDS = 12; // [s] of the traces that are shown
const byId = (id) => document.getElementById(id);
const problems = byId("problems");

function trouble(text) {
    problems.textContent += `${text}\n`;
    problems.dataset.count = Number(problems.dataset.count) + 1;
}

/** Words for the reader of the page: what failed and what can be done; "" takes them away. */
function say(text, isNote = false) {
    const place = byId("message");
    place.textContent = text;
    place.hidden = !text;
    place.classList.toggle("note", isNote);
}

const bytesOf = (id) => Uint8Array.from(atob(byId(id).textContent), (c) => c.charCodeAt(0));

const unpacked = (id) => new Response(new Blob([bytesOf(id)]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();

/** The library with SIMD, which is packed because browsers that have SIMD can unpack it, and the library for all browsers. */
async function sources() {
    const plain = byId("wasm").dataset.packed ? await unpacked("wasm") : bytesOf("wasm");
    return typeof DecompressionStream === "function" ? [await unpacked("simd"), plain] : [plain];
}

class Live {
    constructor(record) {
        Object.assign(this, { record, frames: 0, running: false, ready: false, last: null, waiting: [] });
        this.view = new View(byId("view"), (text) => {
            if (text) say(text, true);
            this.redraw = true;
        });
        this.view.setStrings(record.strings, record.with_bit);
        this.traces = record.traces.map((trace) => {
            const place = document.createElement("div");
            place.className = "trace";
            byId("traces").append(place);
            return new Trace(place, trace, SECONDS);
        });
        this.sliders();
        this.buttons();
        this.pointers();
        this.keys();
        this.loop();
    }

    // ---- Worker -----------------------------------------------------------------------------------------------------------------------
    async start() {
        if (typeof WebAssembly !== "object") {
            say(word("This browser has no WebAssembly, which computes the string. Every browser since 2018 has it: update this one, or open the page in another."));
            return;
        }
        const text = byId("worker").textContent;
        this.worker = new Worker(URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
        this.worker.onmessage = ({ data }) => this.answers[data.type].call(this, data);
        this.worker.onerror = (event) => {
            trouble(event.message);
            say(word("The computation stopped: {reason}. Reload the page.", { reason: event.message }));
        };
        byId("clock").textContent = this.record.static ? word("computing the static equilibrium ...") : word("starting ...");
        this.post("load", { sources: await sources(), record: this.record, memory: 2 ** 20 * Number(/memory=(\d+)/.exec(location.hash)?.[1] ?? 1024) });
    }

    post(type, more = {}) {
        this.worker?.postMessage({ type, ...more });
    }

    get answers() {
        return {
            ready({ line, diameter, bytes, lanes }) {
                Object.assign(this, { ready: true, bytes, lanes, samples: null });
                this.setRunning(false);
                this.diameter = diameter;
                this.view.setLine(line);
                this.view.lookAt(this.view.where ?? "whole");
                this.scaleView();
                this.traces.forEach((trace) => trace.clear());
                this.showDiameter();
                say("");
                if (this.view.pen) say(word("This browser has no WebGL: the string is drawn as lines."), true);
            },
            frame(data) {
                this.last = data;
                this.setRunning(data.running);
                this.view.setFrame(data);
                for (const [time, ...values] of data.samples) this.addSample(time, values);
                this.redraw = true; // several may come between two pictures
                if (data.hash) this.settle(data);
            },
            failed({ what, reason, advice, time }) {
                this.setRunning(false);
                const said = { reason: word("{message}", { message: reason }), time: time.toFixed(3) };
                say(`${what === "start" ? word("The scene could not start: {reason}", said) : word("Failed at {time} s: {reason}", said)}\n${advice}`);
                this.settle({ failed: reason });
            },
            restored({ time }) {
                this.traces.forEach((trace) => trace.clear(time));
            },
            log({ log }) {
                const link = document.createElement("a");
                link.href = URL.createObjectURL(new Blob([JSON.stringify(log, null, 1)], { type: "application/json" }));
                link.download = `${this.record.file}_${log.time.toFixed(3)}s.json`;
                link.click();
                setTimeout(() => URL.revokeObjectURL(link.href), 1000);
                this.lastLog = log;
                this.settle(log);
            },
        };
    }

    /** Resolves with the next picture of a sim that stands, or with the reason of a failure: for tests and other scripts. */
    next() {
        return new Promise((resolve) => this.waiting.push(resolve));
    }

    settle(data) {
        for (const resolve of this.waiting.splice(0)) resolve(data);
    }

    addSample(time, values) {
        let at = 0;
        for (const trace of this.traces) {
            trace.add(time, values.slice(at, at + trace.trace.lines.length));
            at += trace.trace.lines.length;
        }
    }

    // ---- Pictures ---------------------------------------------------------------------------------------------------------------------
    loop() {
        const draw = () => {
            try {
                if (this.redraw && this.last) this.picture();
            } catch (error) {
                trouble(error.stack ?? String(error));
            }
            requestAnimationFrame(draw);
        };
        requestAnimationFrame(draw);
        addEventListener("resize", () => (this.redraw = true));
    }

    picture() {
        this.redraw = false;
        this.view.draw();
        let at = 0;
        for (const trace of this.traces) {
            trace.show(this.last.values.slice(at));
            at += trace.trace.lines.length;
            trace.draw();
        }
        this.texts(this.last);
        byId("view").querySelector(".legend b").textContent = `${shown(this.view.force / 1000)} kN/m`;
        this.frames += 1;
        document.body.dataset.frames = this.frames;
    }

    /** Sliders, buttons and clock of a state. */
    texts({ inputs, kept, running, pace, time, hash }) {
        this.showInputs(inputs);
        byId("restore").disabled = kept === null;
        byId("restore").textContent = kept === null ? word("Restore") : word("Restore {time} s", { time: kept.toFixed(2) });
        const fast = running && pace ? `, ${word("{pace} times real time", { pace: pace < 10 ? pace.toFixed(1) : pace.toFixed(0) })}` : "";
        byId("clock").innerHTML = `<b>${time.toFixed(3)} s</b>${fast}${hash ? `, ${word("hash {hash}", { hash })}` : ""}`;
    }

    /** Exaggeration by the length that is shown, unless the reader chose one. */
    scaleView() {
        if (!this.view.line) return;
        if (!this.chosen) this.view.exaggeration = this.toScale ? 1 : this.view.usualExaggeration();
        const k = this.view.exaggeration, range = byId("exaggeration"), length = shown(this.view.camera.length), factor = k < 10 ? k.toFixed(1) : k.toFixed(0);
        range.value = Math.log10(k);
        range.nextElementSibling.textContent = k < 1.005 ? word("to scale") : word("{factor} times", { factor });
        byId("view").querySelector(".scale").textContent = k < 1.005 ? word("{length} m shown, to scale", { length }) : word("{length} m shown, across the hole {factor} times as large", { length, factor });
        byId("toscale").setAttribute("aria-pressed", k < 1.005);
        this.redraw = true;
    }

    zoom(factor) {
        const { camera } = this.view;
        camera.length = Math.min(Math.max(camera.length * factor, 0.3), 2 * this.view.wholeLength);
        this.scaleView();
    }

    turn(right, up) {
        const { camera } = this.view;
        camera.turn -= right;
        camera.rise = Math.min(Math.max(camera.rise + up, -1.5), 1.5);
        this.redraw = true;
    }

    // ---- Controls -----------------------------------------------------------------------------------------------------------------------
    setRunning(value) {
        this.running = value;
        byId("go").textContent = value ? word("Stop") : word("Run");
    }

    buttons() {
        byId("go").onclick = () => this.go();
        byId("step").onclick = () => this.post("step");
        byId("reset").onclick = () => this.post("reset");
        byId("keep").onclick = () => this.post("keep");
        byId("restore").onclick = () => this.post("restore");
        byId("save").onclick = () => this.post("log");
        byId("speed").onchange = ({ target }) => this.post("speed", { value: Number(target.value) });
        for (const button of document.querySelectorAll("[data-look]"))
            button.onclick = () => {
                if (!this.view.line) return;
                this.view.lookAt(button.dataset.look);
                this.scaleView();
            };
        byId("toscale").onclick = () => {
            this.toScale = !this.toScale;
            this.chosen = false;
            this.scaleView();
        };
        byId("exaggeration").oninput = ({ target }) => {
            this.chosen = true;
            this.toScale = false;
            this.view.exaggeration = 10 ** Number(target.value);
            this.scaleView();
        };
    }

    go(until) {
        if (!this.ready) return;
        if (this.running) {
            this.post("stop");
        } else {
            say("");
            this.setRunning(true);
            this.post("run", { until });
        }
    }

    /** A slider for each input, and one for the diameter of the hole, which needs the scene from its beginning. */
    sliders() {
        this.inputs = this.record.controls.map((control, number) => {
            const made = this.slider(control, (value) => this.post("set", { number, value: value / control.factor }));
            made.changed = false;
            return made;
        });
        const { diameter, diameters } = this.record;
        if (!diameter) return;
        const control = { title: word("Hole diameter"), unit: "mm", low: 1000 * diameters[0], high: 1000 * diameters[1], note: word("restarts the run") };
        this.hole = this.slider(control, () => {}, (value) => {
            byId("clock").textContent = word("building the model again ...");
            this.post("rebuild", { diameter: value / 1000 });
        });
    }

    slider({ title, unit, low, high, note, whole }, input, change) {
        const row = document.createElement("label"), name = document.createElement("span"), output = document.createElement("output"), range = document.createElement("input");
        row.className = "slider";
        name.textContent = title;
        Object.assign(range, { type: "range", min: low, max: high, step: whole ? 1 : (high - low) / 200 });
        row.append(name, output, range);
        byId("sliders").append(row);
        const made = { range, show: (value, more = note) => (output.innerHTML = `${shown(value)} ${unit}${more ? ` <small>${more}</small>` : ""}`) };
        range.oninput = () => {
            made.show(Number(range.value));
            input(Number(range.value));
        };
        if (change) range.onchange = () => change(Number(range.value));
        return made;
    }

    showInputs(states) {
        states.forEach(({ is_set, value, present }, k) => {
            const { range, show } = this.inputs[k], factor = this.record.controls[k].factor;
            if (document.activeElement !== range || !is_set) range.value = value * factor;
            const onTheWay = is_set && Math.abs(present - value) > 1e-6 * Math.abs(value) + 1e-12;
            show(value * factor, is_set ? (onTheWay ? word("now {value}", { value: shown(present * factor) }) : "") : word("as in the scene"));
        });
    }

    showDiameter() {
        if (!this.hole || !this.diameter) return;
        this.hole.range.value = 1000 * this.diameter;
        this.hole.show(1000 * this.diameter);
    }

    keys() {
        const keys = { " ": () => this.go(), s: () => this.post("step"), r: () => this.post("reset"), k: () => this.post("keep"), l: () => this.last?.kept !== null && this.post("restore"),
                       "+": () => this.zoom(0.8), "=": () => this.zoom(0.8), "-": () => this.zoom(1.25) };
        const arrows = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
        addEventListener("keydown", (event) => {
            if (event.ctrlKey || event.metaKey || event.altKey) return;
            const { tagName } = event.target, key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
            if (tagName === "SELECT" || (tagName === "INPUT" && key in arrows) || (tagName === "SUMMARY" && key === " ")) return;
            if (keys[key]) keys[key]();
            else if (arrows[key]) this.turn(...arrows[key]);
            else return;
            event.preventDefault();
            if (tagName === "BUTTON") event.target.blur(); // space would press it too
        });
    }

    pointers() {
        const scene = byId("view").querySelector(".scene"), down = new Map(); // the canvas in it may be replaced
        const spread = () => {
            const [a, b] = [...down.values()];
            return Math.hypot(a.x - b.x, a.y - b.y);
        };
        scene.addEventListener("pointerdown", (event) => {
            scene.setPointerCapture(event.pointerId);
            down.set(event.pointerId, { x: event.clientX, y: event.clientY });
        });
        scene.addEventListener("pointermove", (event) => {
            const before = down.get(event.pointerId);
            if (!before) return;
            const wide = down.size === 2 ? spread() : 0;
            down.set(event.pointerId, { x: event.clientX, y: event.clientY });
            if (down.size === 2) this.zoom(wide / Math.max(spread(), 1));
            else this.turn(0.008 * (event.clientX - before.x), 0.008 * (event.clientY - before.y));
        });
        for (const name of ["pointerup", "pointercancel"]) scene.addEventListener(name, (event) => down.delete(event.pointerId));
        scene.addEventListener("wheel", (event) => {
            event.preventDefault();
            this.zoom(Math.exp(0.0012 * event.deltaY));
        }, { passive: false });
    }
}

addEventListener("error", (event) => trouble(event.message));
addEventListener("unhandledrejection", (event) => trouble(String(event.reason)));
const record = JSON.parse(byId("scene").textContent);
speak(record.words);
globalThis.live = new Live(record);
globalThis.live.start();
