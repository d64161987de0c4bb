// libdrillmbd for JavaScript: describe a model, compile it, make sims, step and query them. All values are in SI units, fields have
// the names of the C structs. `load` (index.mjs) finds the library; `instantiate` takes its bytes or module.
import { CONSTANTS, METHODS, STRUCTS } from "./interface.mjs";

export const constants = Object.freeze(CONSTANTS);
const PAGE = 65536;
const MESSAGE = /^(?:([^:=]+?):\s+)?([^=:;]+?)\s+=\s+(\([^)]*\)|\{[^}]*\}|[^,;]+?),\s+must\s+([^;]*?)(?:;\s*(.*))?$/s;

/** A call that was refused or failed with nothing changed: status, name ("DMB_ERR_VALUE"), and the parts of its message. */
export class DrillError extends Error {
    constructor(status, name, message) {
        super(`${name}: ${message}`);
        this.name = "DrillError";
        const found = MESSAGE.exec(message) ?? [];
        Object.assign(this, { status, statusName: name, text: message, part: found[1] ?? null, field: found[2] ?? null,
                              value: found[3] ?? null, bound: found[4] ?? null, advice: found[5] ?? null });
    }
}

/** A place on a part: `fraction` of pipe number `pipe` of a string, or a body or bit. */
export const station = (part, pipe = 0, fraction = 0) => ({ part, pipe, fraction });

/** The first of several sources (bytes) that this engine compiles, in their order: one with SIMD, then one without. */
export async function compiled(sources) {
    for (const [number, source] of sources.entries()) {
        try {
            return await WebAssembly.compile(source);
        } catch (error) { // an instruction that the engine lacks
            if (!(error instanceof WebAssembly.CompileError) || number === sources.length - 1) throw error;
        }
    }
    throw new TypeError("sources is empty, must have at least one");
}

/** The library in its own memory. options.maximumMemory: [byte] most that it may take, at most 2 GiB. */
export async function instantiate(source, options = {}) {
    const most = Math.min(32768, Math.max(64, Math.floor((options.maximumMemory ?? 2 ** 31) / PAGE)));
    const memory = new WebAssembly.Memory({ initial: 64, maximum: most });
    const library = new Library(memory);
    const imports = { env: { memory }, drillmbd: { time_function: (...given) => library._timeFunction(...given) } };
    const made = await WebAssembly.instantiate(source, imports);
    library._begin((made.instance ?? made).exports);
    return library;
}

class Library {
    constructor(memory) {
        this.memory = memory;
        this.broken = null; // why the library can no longer be used
        this._thrown = null; // by a time function of the call that failed
        this._functions = [null]; // time functions of JavaScript, by number
        this._defaults = new Map();
    }

    _begin(exports) {
        this.exports = exports;
        this._refresh();
        this._cell = this._allocate(8); // for destroy, which never fails
    }

    /** Elements that are computed at once: 2 with SIMD, else 1. Results are the same. */
    get lanes() {
        return this._run("web_lanes");
    }

    /** A model to describe a scene in. */
    model() {
        return new Model(this);
    }

    /** "0.1.0" */
    get version() {
        const number = this._run("dmb_version");
        return [Math.floor(number / 10000), Math.floor(number / 100) % 100, number % 100].join(".");
    }

    /** Number and unit of an output by its name, as "bit_speed". */
    output(name) {
        return this._scratch((take) => {
            const [text, number, unit] = [take.text(name), take(4), take(4)];
            const status = this._run("dmb_output_quantity", text, number);
            if (status < 0) this._fail(status, `output: quantity = ${name}, must be the name of an output, as bit_speed`);
            const quantity = this.view.getInt32(number, true);
            this._run("dmb_output_name", quantity, unit);
            return { quantity, unit: this._text(this.view.getUint32(unit, true)) };
        });
    }

    /** A struct with the library's defaults, as a plain object. */
    defaults(name) {
        const layout = STRUCTS[name];
        return this._scratch((take) => this._read(layout, this._blank(name, layout, take)));
    }

    // ---- Calls --------------------------------------------------------------------------------------------------------------------
    /** Calls a function of C. A trap leaves the memory in a state that nothing is known of, so the library ends there. */
    _run(name, ...given) {
        if (this.broken) throw new DrillError(0, "STOPPED", this.broken);
        try {
            return this.exports[name](...given);
        } catch (error) {
            if (!(error instanceof WebAssembly.RuntimeError) && !(error instanceof RangeError)) throw error;
            this.broken = `the library stopped within ${name.replace("dmb_", "")} (${error.message}); load it again`;
            throw new DrillError(0, "STOPPED", this.broken);
        } finally {
            this._refresh();
        }
    }

    _refresh() {
        if (this.view?.buffer !== this.memory.buffer) this.view = new DataView(this.memory.buffer);
    }

    _fail(status, message) {
        const name = this._text(this._run("dmb_status_name", status));
        const error = new DrillError(status, name, message || this._text(this._run("dmb_status_text", status)));
        if (this._thrown) error.cause = this._thrown;
        this._thrown = null;
        throw error;
    }

    _allocate(size) {
        const at = this._run("malloc", Math.max(size, 8));
        if (!at) this._fail(constants.ERR_NO_MEMORY, `${size} bytes could not be allocated; describe fewer elements, or allow more memory`);
        return at;
    }

    /** Calls work(take); what take(size) gives is freed after it. */
    _scratch(work) {
        const taken = [];
        const take = (size) => {
            taken.push(this._allocate(size));
            return taken[taken.length - 1];
        };
        take.text = (text) => {
            const bytes = new TextEncoder().encode(`${text}\0`);
            const at = take(bytes.length);
            new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
            return at;
        };
        try {
            return work(take);
        } finally {
            if (!this.broken) for (const at of taken) this._run("free", at);
        }
    }

    _text(at) {
        const bytes = new Uint8Array(this.memory.buffer);
        let end = at;
        while (bytes[end]) end += 1;
        return new TextDecoder().decode(bytes.subarray(at, end));
    }

    _timeFunction(number, time, out) {
        let found;
        try {
            found = [this._functions[number](time)].flat();
        } catch (error) { // an exception may not pass through the frames of C
            this._thrown = error;
            return 1;
        }
        this._refresh();
        found.forEach((value, k) => this.view.setFloat64(out + 8 * k, value, true));
        return 0;
    }

    // ---- Structs ------------------------------------------------------------------------------------------------------------------
    _blank(name, layout, take) {
        const at = take(layout.size);
        new Uint8Array(this.memory.buffer, at, layout.size).fill(0);
        if (layout.sized) this._run(`${name}_init`, at, layout.size);
        return at;
    }

    _write(name, at, given, take) {
        const layout = STRUCTS[name];
        if (name === "dmb_place" && given?.generation !== undefined) given = station(given); // a part where a place is asked for
        for (const [key, value] of Object.entries(given ?? {})) {
            const field = layout.fields.find((one) => one[0] === key);
            if (field) this._writeField(name, at, layout, field, value, take);
            else if (name === "dmb_segment" && key === "function") this._writeFunction(at, layout, value);
            else throw new TypeError(`${name.slice(4)}: ${key} = ${value}, must be one of its fields: ${layout.fields.map((one) => one[0]).join(", ")}`);
        }
    }

    _writeFunction(at, layout, value) {
        const place = (key) => at + layout.fields.find((one) => one[0] === key)[3];
        this.view.setInt32(place("kind"), constants.SEGMENT_CALLBACK, true);
        this.view.setUint32(place("callback"), this._run("web_time_function_address"), true);
        this.view.setUint32(place("callback_context"), this._functions.push(value) - 1, true);
    }

    _writeField(name, at, layout, [key, letter, count, offset, numbers, counter, width], value, take) {
        const place = at + offset;
        if (letter === "c") {
            this._writeText(name, key, place, count, value);
        } else if (letter === "p") {
            if (value === null || value === undefined) return this.view.setUint32(place, 0, true);
            if (!numbers) throw new TypeError(`${name.slice(4)}: ${key} is a pointer, which JavaScript cannot give; leave it out`);
            const block = take(8 * value.length);
            for (let i = 0; i < value.length; i++) this._number(numbers, block + (numbers === "d" ? 8 : 4) * i, value[i], name, key);
            this.view.setUint32(place, block, true);
            const count_of = layout.fields.find((one) => one[0] === counter);
            if (count_of) this.view.setUint32(at + count_of[3], value.length / width, true);
        } else if (!count) {
            this._one(letter, place, value, name, key, take);
        } else {
            if (value.length !== count) throw new RangeError(`${name.slice(4)}: ${key} has ${value.length} values, must have ${count}`);
            const size = STRUCTS[letter]?.size ?? (letter === "i" || letter === "u" ? 4 : 8);
            for (let i = 0; i < count; i++) this._one(letter, place + size * i, value[i], name, `${key}[${i}]`, take);
        }
    }

    _writeText(name, key, place, count, value) {
        const bytes = new TextEncoder().encode(value);
        if (bytes.length >= count) throw new RangeError(`${name.slice(4)}: ${key} = ${value} has ${bytes.length} bytes, must have at most ${count - 1}`);
        const target = new Uint8Array(this.memory.buffer, place, count).fill(0);
        target.set(bytes);
    }

    _one(letter, place, value, name, key, take) {
        if (STRUCTS[letter]) this._write(letter, place, value, take);
        else this._number(letter, place, value, name, key);
    }

    _number(letter, place, value, name, key) {
        const wanted = letter === "l" || letter === "L" ? "bigint" : "number";
        if (typeof value !== wanted) throw new TypeError(`${name.slice(4)}: ${key} = ${value}, must be a ${wanted}`);
        const most = letter === "i" ? 2 ** 31 : 2 ** 32;
        if ((letter === "i" || letter === "u") && !(Number.isInteger(value) && value < most && value >= (letter === "i" ? -most : 0)))
            throw new RangeError(`${name.slice(4)}: ${key} = ${value}, must be a whole number ${letter === "i" ? -most : 0} .. ${most - 1}`);
        if (letter === "d") this.view.setFloat64(place, value, true);
        else if (letter === "i") this.view.setInt32(place, value, true);
        else if (letter === "u") this.view.setUint32(place, value, true);
        else this.view.setBigUint64(place, BigInt.asUintN(64, value), true);
    }

    _read(layout, at) {
        const found = {};
        for (const [key, letter, count, offset] of layout.fields)
            if (key !== "struct_size" && !/reserved\d*$/.test(key) && letter !== "p") found[key] = this._value(letter, count, at + offset);
        return found;
    }

    _value(letter, count, at) {
        if (letter === "c") return this._text(at);
        if (letter === "d" && count) return Float64Array.from({ length: count }, (_, i) => this.view.getFloat64(at + 8 * i, true));
        const size = STRUCTS[letter]?.size ?? ("iu".includes(letter) ? 4 : 8);
        if (count) return Array.from({ length: count }, (_, i) => this._value(letter, 0, at + size * i));
        if (STRUCTS[letter]) return this._read(STRUCTS[letter], at);
        if (letter === "d") return this.view.getFloat64(at, true);
        if (letter === "i") return this.view.getInt32(at, true);
        if (letter === "u") return this.view.getUint32(at, true);
        return letter === "l" ? this.view.getBigInt64(at, true) : this.view.getBigUint64(at, true);
    }

    /** Calls one of the functions of METHODS: inputs as given, outputs as its result. */
    _method(owner, [name, result, parameters], given) {
        return this._scratch((take) => {
            const words = [owner._handle], outs = [];
            let next = 0;
            for (const [way, letter, key, length] of parameters) {
                if (way === "out") {
                    const layout = STRUCTS[letter];
                    const at = layout ? this._blank(letter, layout, take) : take(8 * (length ?? 1));
                    outs.push([key, letter, length ?? 0, at]);
                    words.push(at);
                } else {
                    words.push(...this._argument(way, letter, key, given[next++], take, name));
                }
            }
            const status = this._run(name, ...words);
            if (result !== "s") return status;
            if (status < 0) this._fail(status, owner.message);
            owner.status = status;
            if (outs.length === 0) return status;
            const values = outs.map(([key, letter, length, at]) => [key, this._value(letter, length, at)]);
            return values.length === 1 ? values[0][1] : Object.fromEntries(values);
        });
    }

    _argument(way, letter, key, value, take, name) {
        if (way === "text") return [take.text(value)];
        const layout = STRUCTS[letter];
        if (way === "list") {
            const block = take(layout.size * Math.max(value.length, 1));
            value.forEach((one, i) => {
                new Uint8Array(this.memory.buffer, block + layout.size * i, layout.size).fill(0);
                if (layout.sized) this._run(`${letter}_init`, block + layout.size * i, layout.size);
                this._write(letter, block + layout.size * i, one, take);
            });
            return [block, value.length];
        }
        if (layout) {
            const at = this._blank(letter, layout, take);
            this._write(letter, at, value, take);
            return [at];
        }
        const at = take(8);
        this._number(letter, at, value, name, key);
        return [value];
    }
}

class Handle {
    constructor(library) {
        this.library = library;
        this.status = 0; // of the last call: > 0 for one that has something to note, see `message`
    }

    _create(create, ...given) {
        return this.library._scratch((take) => {
            const at = take(4);
            const status = this.library._run(create, ...given, at);
            this._handle = this.library.view.getUint32(at, true);
            return status;
        });
    }

    _destroy(destroy) {
        if (this._handle) {
            this.library.view.setUint32(this.library._cell, this._handle, true);
            this.library._run(destroy, this.library._cell);
        }
        this._handle = 0;
    }

    get message() {
        return this.library._text(this.library._run(this._messageOf, this._handle));
    }
}

/** A scene: described part by part, then compiled. */
export class Model extends Handle {
    constructor(library) {
        super(library);
        this._messageOf = "dmb_model_message";
        const status = this._create("dmb_model_create", 0);
        if (status < 0) library._fail(status, "");
    }

    /** Pipes of one definition at the end of a string; `count` of them. */
    addPipes(definition, count = 1) {
        return this.library._method(this, METHODS.Model.addPipes, [definition, count]);
    }

    /** A sim of the compiled model at time 0, with these SimOptions. */
    sim(options) {
        return new Sim(this, options);
    }

    destroy() {
        this._destroy("dmb_model_destroy");
    }
}

/** One simulation of a compiled model. */
export class Sim extends Handle {
    constructor(model, options = {}) {
        super(model.library);
        this._messageOf = "dmb_sim_message";
        const library = this.library;
        this.status = library._scratch((take) => {
            const at = library._blank("dmb_sim_options", STRUCTS.dmb_sim_options, take);
            library._write("dmb_sim_options", at, options, take);
            return this._create("dmb_sim_create", model._handle, at);
        });
        if (this.status < 0) library._fail(this.status, model.message);
    }

    /** [s] of the last accepted state. */
    get time() {
        return this.library._run("dmb_sim_time", this._handle);
    }

    /** 16 hexadecimal digits; equal states have equal hashes, on every machine. */
    hash() {
        return this.library._scratch((take) => {
            const at = take(8);
            this._check(this.library._run("dmb_sim_hash", this._handle, at));
            return this.library.view.getBigUint64(at, true).toString(16).padStart(16, "0");
        });
    }

    /** Advances by `duration` [s] in one step. Returns the status, > 0 with something to note. */
    step(duration) {
        return this._check(this.library._run("dmb_sim_step", this._handle, duration, 0));
    }

    /** Advances to `time` [s] by steps of the library's choice. */
    advance(time) {
        return this._check(this.library._run("dmb_sim_advance", this._handle, time, 0));
    }

    /** One output by number or name, at a place (null: of the whole scene). */
    output(quantity, place = null) {
        const number = typeof quantity === "string" ? this.library.output(quantity).quantity : quantity;
        return this.queryOutput(place === null ? { quantity: number } : { quantity: number, place });
    }

    /** Quantities PROFILE_... at `stations` places spread evenly along a string: shape (stations, quantities). */
    profile(quantities, stations, string = null) {
        const library = this.library;
        return library._scratch((take) => {
            const at = library._blank("dmb_profile", STRUCTS.dmb_profile, take), length = stations * quantities.length;
            library._write("dmb_profile", at, { station_count: stations, quantities, ...(string ? { string } : {}) }, take);
            const values = take(8 * length);
            library.view.setUint32(at + STRUCTS.dmb_profile.fields.find((one) => one[0] === "values")[3], values, true);
            this._check(library._run("dmb_query_profile", this._handle, at));
            return new Float64Array(library.memory.buffer, values, length).slice();
        });
    }

    /** The state as bytes; restore takes them in any sim of the same model and options, and goes on with the same bits. */
    snapshot() {
        const library = this.library;
        return library._scratch((take) => {
            const at = take(4);
            this._check(library._run("dmb_sim_snapshot_size", this._handle, at));
            const size = library.view.getUint32(at, true), block = take(size);
            this._check(library._run("dmb_sim_snapshot", this._handle, block, size));
            return new Uint8Array(library.memory.buffer, block, size).slice();
        });
    }

    restore(bytes) {
        const library = this.library;
        return library._scratch((take) => {
            const block = take(bytes.length);
            new Uint8Array(library.memory.buffer, block, bytes.length).set(bytes);
            return this._check(library._run("dmb_sim_restore", this._handle, block, bytes.length));
        });
    }

    destroy() {
        this._destroy("dmb_sim_destroy");
    }

    _check(status) {
        if (status < 0) this.library._fail(status, this.message);
        this.status = status;
        return status;
    }
}

for (const [kind, methods] of [[Model, METHODS.Model], [Sim, METHODS.Sim]])
    for (const [name, method] of Object.entries(methods))
        if (!(name in kind.prototype)) kind.prototype[name] = function (...given) { return this.library._method(this, method, given); };
