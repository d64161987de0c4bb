// Makes model and sim of a recorded scene: the calls that described it, with structs by the names of their fields.

/** The record with NaN and infinities, which JSON has as texts, and with the ids stamped for a model. */
function revived(value, generation) {
    if (Array.isArray(value)) return value.map((one) => revived(one, generation));
    if (value === "NaN" || value === "Infinity" || value === "-Infinity") return Number(value);
    if (value === null || typeof value !== "object") return value;
    if ("generation" in value) return { index: value.index, generation: value.generation ? generation : 0 };
    return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, revived(one, generation)]));
}

const camel = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());

/** The structs of a call with another hole diameter: sections that have one of their own keep their ratio to it. */
function widened(name, structs, from, to) {
    if (!to || to === from || (name !== "add_wall" && name !== "add_hole_sections")) return structs;
    return structs.map((one) => (one.diameter > 0 ? { ...one, diameter: name === "add_wall" ? to : one.diameter * (to / from) } : one));
}

/** The model of the record, compiled. diameter [m]: of the hole, instead of the recorded one. owner.model: the model, of a failure too. */
export function modelOf(library, record, diameter, owner = {}) {
    const model = (owner.model = library.model());
    let generation = 0;
    for (const [name, given, count] of record.calls) {
        const structs = widened(name, revived(given, generation), record.diameter, diameter);
        let made = null;
        if (name === "add_time_function") {
            made = model.addTimeFunction(structs);
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
    const made = {};
    try {
        const { model, generation } = modelOf(library, record, diameter, made);
        const sim = (made.sim = model.sim(revived(record.sim, generation)));
        if (record.static) sim.analysisStatic(revived(record.static, generation));
        const inputs = record.controls.map((one) => model.findInput(one.name));
        return { model, sim, inputs, place: (one) => revived(one, generation) };
    } catch (error) { // releases the memory of sim and model
        if (!library.broken) for (const one of [made.sim, made.model]) one?.destroy();
        throw error;
    }
}
