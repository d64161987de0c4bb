// Runs the sim beside the page, in slices, so that neither ever waits for the other.
import { compiled, constants as c, instantiate } from "../drillmbd.mjs";
import { begin } from "./replay.mjs";
import { speak, word } from "./words.mjs";

const SLICE = 12, FRAME = 33; // [ms] of work between two looks for messages; between two pictures
const QUANTITIES = [c.PROFILE_X, c.PROFILE_Y, c.PROFILE_Z, c.PROFILE_DEPTH, c.PROFILE_ROTATION, c.PROFILE_NORMAL_FORCE];
const AXIS_POINTS = 2000;

const state = { library: null, record: null, run: null, running: false, speed: 1, until: Infinity, log: [], calls: 0, kept: null, diameter: null };
const channel = new MessageChannel();

/** Does the work of a message; an error becomes a text for the page, the last accepted state stays. */
function guarded(what, work) {
    try {
        return work();
    } catch (error) {
        state.running = false;
        const advice = state.library?.broken ? word("Press Reset.") : word("The last accepted state is kept: change an input, restore, or reset.");
        postMessage({ type: "failed", what, reason: error.text ?? error.message, advice, time: time() });
        return undefined;
    }
}

const time = () => (state.run && !state.library.broken ? state.run.sim.time : 0);

// ---- Beginning ----------------------------------------------------------------------------------------------------------------------
/** sources: the library in bytes, with SIMD and without; the first that this browser can run is taken. */
async function load({ sources, record, memory }) {
    state.record = record;
    state.sources = sources;
    speak(record.words);
    state.memory = memory;
    await restart(null);
}

/** The scene from its beginning, with another diameter of the hole where one is given; the log of inputs begins anew. */
async function restart(diameter) {
    state.running = false;
    try {
        if (state.library?.broken) Object.assign(state, { run: null, library: null });
        state.library ??= await instance();
        const { library, run } = await another(diameter), before = state.run; // what there was goes only when this has succeeded
        if (library === state.library) {
            before?.sim.destroy();
            before?.model.destroy();
        }
        Object.assign(state, { library, run, diameter, log: [], calls: 0, kept: null, until: Infinity, nextSample: -Infinity, hundredth: 0 });
        run.places = state.record.traces.flatMap((trace) => trace.lines.map((line) => ({ quantity: line.quantity, place: run.place(line.place) })));
        run.line = referenceLine(run);
        postMessage({ type: "ready", line: run.line, diameter: diameter ?? state.record.diameter, bytes: state.library.memory.buffer.byteLength, lanes: state.library.lanes });
        frame(true);
    } catch (error) {
        postMessage({ type: "failed", what: "start", reason: error.text ?? error.message, time: time(),
                      advice: state.run ? word("The scene before it continues.") : word("This scene cannot run in this browser.") });
        if (state.run) guarded("frame", () => frame(true));
    }
}

/** The library in a memory of its own. */
async function instance() {
    state.wasm ??= await compiled(state.sources);
    return instantiate(state.wasm, { maximumMemory: state.memory });
}

/** The beginning of the scene beside the run that there is. Where the memory does not hold both, it gets a memory of its own. */
async function another(diameter) {
    try {
        return { library: state.library, run: begin(state.library, state.record, diameter) };
    } catch (error) {
        if (!state.run || error.statusName !== "DMB_ERR_NO_MEMORY") throw error;
    }
    const library = await instance();
    return { library, run: begin(library, state.record, diameter) };
}

/** Quantities along all strings, one after the other. */
function along(quantities) {
    const { sim, place } = state.run ?? {};
    const found = state.record.strings.map(({ part, stations }) => sim.profile(quantities, stations, place(part)));
    const all = new Float64Array(found.reduce((sum, one) => sum + one.length, 0));
    found.reduce((at, one) => (all.set(one, at), at + one.length), 0);
    return all;
}

/** The axis of the hole as points with radii; of a scene without hole the string as it lies at the start. */
function referenceLine(run) {
    const { model } = run;
    const shape = along([c.PROFILE_X, c.PROFILE_Y, c.PROFILE_Z, c.PROFILE_DEPTH]), stations = shape.length / 4;
    if (!state.record.diameter) return { start: 0, spacing: 0, points: Float64Array.from({ length: 3 * stations }, (_, i) => shape[4 * Math.floor(i / 3) + (i % 3)]), radii: null };
    const start = Math.max(0, shape.reduce((least, value, i) => (i % 4 === 3 && value < least ? value : least), Infinity)), deepest = shape.reduce((most, value, i) => (i % 4 === 3 && value > most ? value : most), -Infinity), length = 1.02 * (deepest - start) + 0.5;
    const points = new Float64Array(3 * AXIS_POINTS), radii = new Float64Array(AXIS_POINTS), spacing = length / (AXIS_POINTS - 1);
    for (let i = 0; i < AXIS_POINTS; i++) {
        const at = model.queryHole(start + i * spacing);
        points.set(at.position, 3 * i);
        radii[i] = 0.5 * at.diameter;
    }
    return { start, spacing, points, radii };
}

// ---- Steps ----------------------------------------------------------------------------------------------------------------------------
/** One step, as the command makes it: of the length in [run] step, or a hundredth of the run by steps of the library's choice. */
function step() {
    const { sim } = state.run, { step: length, end } = state.record;
    if (length) sim.step(length);
    else sim.advance(((state.hundredth += 1) * (end || 10)) / 100);
    sample();
}

function values() {
    return state.run.places.map((one) => state.run.sim.queryOutput(one));
}

function sample() {
    const at = state.run.sim.time;
    if (at < state.nextSample - 1e-9) return;
    state.nextSample = at + state.record.interval;
    (state.samples ??= []).push([at, ...values()]);
}

function slice() {
    if (!state.running) return;
    guarded("step", () => {
        const began = performance.now();
        const target = state.anchor.time + (state.speed * (began - state.anchor.wall)) / 1000;
        let steps = 0;
        while (time() < Math.min(target, state.until) - 1e-9 && performance.now() - began < SLICE) {
            step();
            steps += 1;
        }
        state.busy = 0.95 * (state.busy ?? 0) + performance.now() - began;
        if (time() < target - 0.1) anchor(); // too slow for this speed: no backlog to catch up with
        if (time() >= state.until - 1e-9) Object.assign(state, { running: false, until: Infinity });
        if (performance.now() - (state.shown ?? 0) > FRAME || !state.running) frame(!state.running);
        if (state.running && steps > 0) channel.port2.postMessage(0);
        else if (state.running) setTimeout(slice, 4);
    });
}
channel.port1.onmessage = slice;

function anchor() {
    state.anchor = { time: time(), wall: performance.now() };
}

/** How fast it runs: simulated over clock time since the last picture. */
function pace() {
    const now = performance.now(), before = state.paced ?? { time: time(), wall: now };
    if (now - before.wall < 500) return state.pace ?? null;
    state.pace = (1000 * (time() - before.time)) / (now - before.wall);
    state.paced = { time: time(), wall: now };
    return state.pace;
}

// ---- Pictures -----------------------------------------------------------------------------------------------------------------------
/** The point of the reference line beside station i, and how far the station is from it. */
function offsets(run, profile, stations) {
    const { start, spacing, points } = run.line, last = points.length / 3 - 1;
    const base = new Float32Array(3 * stations), offset = new Float32Array(3 * stations);
    for (let i = 0; i < stations; i++) {
        const at = spacing ? Math.min(Math.max((profile[6 * i + 3] - start) / spacing, 0), last - 1e-9) : i;
        const k = Math.floor(at), f = spacing ? at - k : 0;
        for (let x = 0; x < 3; x++) {
            const on = points[3 * k + x] + (f ? f * (points[3 * k + 3 + x] - points[3 * k + x]) : 0);
            base[3 * i + x] = on;
            offset[3 * i + x] = profile[6 * i + x] - on;
        }
    }
    return { base, offset };
}

function frame(isLast) {
    const { run } = state, { sim } = run;
    state.shown = performance.now();
    const profile = along(QUANTITIES), stations = profile.length / QUANTITIES.length;
    const { base, offset } = offsets(run, profile, stations);
    const turn = Float32Array.from({ length: stations }, (_, i) => profile[6 * i + 4]);
    const force = Float32Array.from({ length: stations }, (_, i) => profile[6 * i + 5]);
    const samples = state.samples ?? [];
    state.samples = [];
    const inputs = run.inputs.map((id) => sim.getInput(id)).map(({ is_set, value, present }) => ({ is_set, value, present }));
    const message = { type: "frame", time: sim.time, base, offset, turn, force, samples, values: values(), inputs, running: state.running, pace: pace(),
                      kept: state.kept?.time ?? null, log: state.log.length };
    if (isLast) message.hash = sim.hash();
    postMessage(message, [base.buffer, offset.buffer, turn.buffer, force.buffer]);
}

// ---- Messages -------------------------------------------------------------------------------------------------------------------------
const ANSWERS = {
    load,
    run({ until }) {
        state.until = until ?? Infinity;
        state.running = true;
        state.paced = undefined;
        anchor();
        slice();
    },
    stop() {
        state.running = false;
        frame(true);
    },
    step() {
        state.running = false;
        step();
        frame(true);
    },
    speed({ value }) {
        state.speed = value;
        anchor();
    },
    set({ number, value }) {
        const { sim, inputs } = state.run;
        sim.setInput(inputs[number], value);
        state.log.push({ time: sim.time, input: state.record.controls[number].name, value: sim.getInput(inputs[number]).value, call: state.calls++ });
        if (!state.running) frame(true);
    },
    reset: () => restart(state.diameter),
    rebuild: ({ diameter }) => restart(diameter),
    keep() {
        const { sim } = state.run;
        state.kept = { bytes: sim.snapshot(), time: sim.time, log: [...state.log], calls: state.calls, hundredth: state.hundredth };
        frame(!state.running);
    },
    restore() {
        if (!state.kept) throw new Error("no state is kept yet; press Keep state first");
        state.run.sim.restore(state.kept.bytes);
        Object.assign(state, { log: [...state.kept.log], calls: state.kept.calls, hundredth: state.kept.hundredth, samples: [], nextSample: -Infinity });
        postMessage({ type: "restored", time: state.kept.time });
        anchor();
        frame(!state.running);
    },
    log() {
        const { sim } = state.run;
        postMessage({ type: "log", log: { scene: state.record.title, drillmbd: state.library.version, checksum: state.record.checksum, step: state.record.step,
                                          diameter: state.diameter, time: sim.time, hash: sim.hash(), inputs: state.log } });
    },
};

if (typeof onmessage !== "undefined" && typeof document === "undefined") {
    onmessage = ({ data }) => guarded(data.type, () => ANSWERS[data.type](data));
}
