// Makes model and sim of a recorded scene: the calls that described it, with structs by the names of their fields.
import { constants } from "../drillmbd.mjs";

/** The record with NaN and infinities, which JSON has as texts, and with the ids stamped for a model. */
function revived(value, generation) {
    if (Array.isArray(value)) return value.map((one) => revived(one, generation));
    if (value === "NaN" || value === "Infinity" || value === "-Infinity") return Number(value);
    if (value === null || typeof value !== "object") return value;
    if ("generation" in value) return { index: value.index, generation: value.generation ? generation : 0 };
    return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, revived(one, generation)]));
}

/** [rate, value, integral] of the smooth step from 0 to 1, D^2 (3 - 2 D). */
function smoothStep(time, begin, end) {
    const length = end - begin, x = (time - begin) / length;
    if (x <= 0) return [0, 0, 0];
    if (x >= 1) return [0, 1, 0.5 * length + (time - end)];
    return [(6 * x * (1 - x)) / length, x * x * (3 - 2 * x), length * x * x * x * (1 - 0.5 * x)];
}

function segmentAt(time, one) {
    if (one.kind === constants.SEGMENT_STEP) {
        const [rate, value, integral] = smoothStep(time, one.x0, one.x1), height = one.h1 - one.h0;
        return [height * rate, one.h0 + height * value, one.h0 * time + height * integral];
    }
    if (one.kind === constants.SEGMENT_HARMONIC) {
        const { omega: w, phase } = one;
        const swing = w !== 0 ? (Math.cos(phase) - Math.cos(w * time + phase)) / w : Math.sin(phase) * time;
        return [one.h1 * w * Math.cos(w * time + phase), one.h0 + one.h1 * Math.sin(w * time + phase), one.h0 * time + one.h1 * swing];
    }
    return [0, one.h0, one.h0 * time];
}

/** A speed that swings with the revolutions of another time function: with its rate w and integral theta, share w sin(order theta). */
function perRevolution({ share, order, segments }) {
    return (time) => {
        const sum = [0, 0, 0];
        for (const one of segments) segmentAt(time, one).forEach((value, k) => (sum[k] += value));
        const sine = Math.sin(order * sum[2]), cosine = Math.cos(order * sum[2]);
        return [share * sum[1] * sine, share * (sum[0] * sine + order * sum[1] * sum[1] * cosine), (share * (1 - cosine)) / order];
    };
}

const camel = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());

/** The structs of a call with another hole diameter: sections that have one of their own keep their ratio to it. */
function widened(name, structs, from, to) {
    if (!to || to === from || (name !== "add_wall" && name !== "add_hole_sections")) return structs;
    return structs.map((one) => (one.diameter > 0 ? { ...one, diameter: name === "add_wall" ? to : one.diameter * (to / from) } : one));
}

/** The model of the record, compiled. diameter [m]: of the hole, instead of the recorded one. */
export function modelOf(library, record, diameter) {
    const model = library.model();
    let generation = 0;
    for (const [name, given, count] of record.calls) {
        const structs = widened(name, revived(given, generation), record.diameter, diameter);
        let made = null;
        if (name === "add_time_function") {
            made = model.addTimeFunction(structs.map(({ per_revolution, ...one }) => (per_revolution ? { ...one, function: perRevolution(per_revolution) } : one)));
        } else if (name === "add_hole_sections") {
            model.addHoleSections(structs);
        } else if (name === "set_name") {
            model.setName(structs[0].part, structs[0].name);
        } else {
            made = model[camel(name)](structs[0], count);
        }
        generation = made?.generation || generation;
    }
    return { model, generation };
}

/** Model and sim at the beginning of the run: in the static equilibrium where the scene asks for it. */
export function begin(library, record, diameter) {
    const { model, generation } = modelOf(library, record, diameter);
    const sim = model.sim(revived(record.sim, generation));
    if (record.static) sim.analysisStatic(revived(record.static, generation));
    const inputs = record.controls.map((one) => model.findInput(one.name));
    return { model, sim, inputs, place: (one) => revived(one, generation) };
}
