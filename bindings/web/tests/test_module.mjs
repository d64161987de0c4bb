// The JavaScript module under node: the firmware scene has the hash of the native library, defaults and queries have their values,
// refusals are exceptions with their parts, a full memory and a trap leave nothing behind.
// usage: node test_module.mjs HASH JOINTED_HASH [FOLDER of the built package]
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const [wanted, jointed, folder = "build/web"] = process.argv.slice(2);
const { compiled, constants: c, DrillError, instantiate, load, station } = await import(pathToFileURL(`${folder}/index.mjs`));
const library = await load();

/** tests/firmware/scene.h */
function firmware(pipes = 20) {
    const model = library.model();
    model.addWall({ friction_law: c.FRICTION_STRIBECK });
    model.addPipes({}, pipes);
    const bit = model.addBit({});
    const turning = model.addTimeFunction([{ kind: c.SEGMENT_STEP, x1: 0.05, h1: 10 }]);
    const drive = model.addDrive({ time_function: turning, component: c.RX });
    model.compile({});
    return { model, bit, drive, sim: model.sim({ bounded_work: 1, max_iterations: 4 }) };
}

/** Hash of tests/firmware/jointed.h. */
function jointedHash(own) {
    const model = own.model(), place = (part, pipe = 0, fraction = 0) => station(part, pipe, fraction);
    const strings = [0, 1, 2].map((k) => {
        const string = model.addString({ position: [0, 0, -0.1 * k] });
        model.addPipes({ string, length: 1, outer_diameter: 0.09 - 0.02 * k, inner_diameter: 0.05 - 0.01 * k }, 6);
        return string;
    });
    for (let i = 0; i < 6; i++) {
        const k = i % 2, kind = k === 0 ? c.JOINT_SPHERICAL : c.JOINT_UNIVERSAL;
        model.addJoint({ kind, place_a: place(strings[k], i, 1), place_b: place(strings[k + 1], i, 1), match: 1 });
    }
    const bar = (x, z, angle) =>
        model.addBody({ position: [x, 2, z], rotation: [0, -angle, 0], mass: 1, centre: [0.5, 0, 0], inertia: [0.001, 0.08, 0.08, 0, 0, 0] });
    const hinge = (place_a, origin_a, b) =>
        model.addJoint({ kind: c.JOINT_REVOLUTE, ...(place_a && { place_a }), place_b: place(b), origin_a, axis_a: [0, 1, 0], match: 1 });
    const cranks = [0, 1, 2, 3, 4, 5, 6].map((k) => {
        const crank = bar(k, 0, 1.25);
        hinge(null, [k, 2, 0], crank);
        return crank;
    });
    for (let k = 0; k < 6; k++) {
        const coupler = bar(k + 0.3153223623952687, 0.9489846193555862, 0);
        for (const crank of cranks.slice(k, k + 2)) hinge(place(crank), [1, 0, 0], coupler);
    }
    model.compile();
    const sim = model.sim();
    for (let i = 0; i < 100; i++) sim.step(1e-3);
    const hash = sim.hash();
    sim.destroy();
    model.destroy();
    return hash;
}

/** The DrillError of a call. */
function refusal(call) {
    try {
        call();
    } catch (error) {
        assert.ok(error instanceof DrillError, `${error}`);
        return error;
    }
    return assert.fail("was not refused");
}

test("hash of the firmware scene after 100 steps is that of the native library", () => {
    assert.match(wanted ?? "", /^[0-9a-f]{16}$/, "usage: node test_module.mjs HASH JOINTED_HASH");
    const { sim, model } = firmware();
    for (let i = 0; i < 100; i++) sim.step(1e-3);
    assert.equal(sim.hash(), wanted);
    sim.destroy();
    model.destroy();
});

test("hash of the scene with joints is that of every build", () => {
    assert.match(jointed ?? "", /^[0-9a-f]{16}$/, "usage: node test_module.mjs HASH JOINTED_HASH");
    assert.equal(jointedHash(library), jointed);
});

/** Hash of a string of 101 pipes, an odd number, on its wall after 0.2 s: with contact, friction, impacts and several Newton iterations. */
function onTheWall(own) {
    const model = own.model();
    model.addWall({ friction_law: c.FRICTION_STRIBECK });
    model.addPipes({}, 101);
    model.addBit({});
    model.addDrive({ time_function: model.addTimeFunction([{ kind: c.SEGMENT_STEP, x1: 0.05, h1: 10 }]), component: c.RX });
    model.compile({});
    const sim = model.sim();
    for (let i = 0; i < 200; i++) sim.step(1e-3);
    return sim.hash();
}

test("with SIMD and without: the same bits", async () => {
    const [wide, plain] = await Promise.all(["drillmbd_simd.wasm", "drillmbd.wasm"].map(async (name) => load(await readFile(`${folder}/${name}`))));
    assert.equal(wide.lanes, 2);
    assert.equal(plain.lanes, 1);
    assert.equal(library.lanes, 2, "load() takes the file with SIMD");
    assert.equal(onTheWall(wide), onTheWall(plain));
    assert.equal(jointedHash(plain), jointed);
});

test("an engine without SIMD takes the other file", async () => {
    const code = `import("${pathToFileURL(`${folder}/index.mjs`)}").then(async ({ load }) => console.log((await load()).lanes))`;
    const { stdout, stderr } = spawnSync(process.execPath, ["--no-enable-sse4-1", "-e", code], { encoding: "utf8" });
    assert.equal(stdout.trim(), "1", stderr);
    await assert.rejects(compiled([new Uint8Array([1, 2, 3])]), WebAssembly.CompileError);
    const spare = await instantiate(await compiled([new Uint8Array([1, 2, 3]), await readFile(`${folder}/drillmbd.wasm`)]));
    assert.equal(spare.lanes, 1);
});

test("queries answer with named fields and typed arrays", () => {
    const { sim, model, bit, drive } = firmware();
    for (let i = 0; i < 100; i++) sim.step(1e-3);
    const pose = sim.queryPose(bit);
    assert.ok(pose.position instanceof Float64Array && pose.position.length === 3);
    assert.ok(Math.abs(pose.position[0] - model.getInfo().length) < 0.01, "the bit is at the string's end");
    const state = sim.queryDrive(drive);
    assert.equal(state.speed, 10);
    assert.ok(state.force > 0);
    assert.equal(sim.output("drive_force", drive), state.force);
    assert.ok(Math.abs(sim.time - 0.1) < 1e-12);
    const [depth, spin] = sim.profile([c.PROFILE_DISTANCE, c.PROFILE_SPIN], 2).slice(2);
    assert.equal(depth, model.getInfo().length);
    assert.ok(Math.abs(spin - sim.output("bit_speed")) < 1e-12);
    assert.equal(typeof sim.queryStatistics().steps, "bigint");
    assert.equal(model.queryHole(1).diameter, library.defaults("dmb_wall_def").diameter);
    sim.destroy();
    model.destroy();
});

test("a restored state goes on with the same bits", () => {
    const { sim, model } = firmware();
    for (let i = 0; i < 20; i++) sim.step(1e-3);
    const kept = sim.snapshot(), hash = sim.hash();
    for (let i = 0; i < 20; i++) sim.step(1e-3);
    const later = sim.hash();
    sim.restore(kept);
    assert.equal(sim.hash(), hash);
    for (let i = 0; i < 20; i++) sim.step(1e-3);
    assert.equal(sim.hash(), later);
    kept[100] ^= 255;
    assert.ok(refusal(() => sim.restore(kept.slice(1))).status < 0);
    assert.equal(sim.hash(), later, "a refused state changes nothing");
});

test("a survey, a table and a function of JavaScript go in", () => {
    const model = library.model();
    model.addWall({ survey: [0, Math.PI / 2, 0, 10, Math.PI / 2, 0, 40, 1.4, 0.1] });
    model.addPipes({ length: 3, outer_diameter: 0.0635, inner_diameter: 0.05 }, 3);
    const table = model.addTimeFunction([{ kind: c.SEGMENT_TABLE, table_time: [0, 1], table_value: [0, 2] }]);
    const own = model.addTimeFunction([{ function: (time) => [0.3 * time * time, 0.6 * time, 0.1 * time ** 3],
                                         provides: c.PROVIDES_RATE | c.PROVIDES_INTEGRAL }]);
    const feed = model.addDrive({ component: c.X, time_function: own }), turn = model.addDrive({ component: c.RX, time_function: table });
    model.compile({});
    const sim = model.sim();
    for (let i = 0; i < 100; i++) sim.step(1e-3);
    assert.ok(Math.abs(sim.queryDrive(turn).speed - 0.2) < 1e-12);
    assert.ok(Math.abs(sim.queryDrive(feed).speed - 0.003) < 1e-12);
    assert.ok(Math.abs(model.queryHole(40).inclination - 1.4) < 1e-12);
});

test("refusals name part, field, value and bound", () => {
    const model = library.model();
    const error = refusal(() => model.addWall({ diameter: -1 }));
    assert.equal(error.statusName, "DMB_ERR_VALUE");
    assert.equal(error.status, c.ERR_VALUE);
    assert.equal(error.field, "diameter");
    assert.equal(error.value, "-1");
    assert.ok(error.bound);
    assert.throws(() => model.addWall({ diametre: 1 }), /diametre.*must be one of its fields/);
    assert.throws(() => model.addWall({ diameter: "94 mm" }), /must be a number/);
    assert.throws(() => model.addWall({ name: "x".repeat(24) }), /at most 23/);
    assert.equal(refusal(() => model.sim()).statusName, "DMB_ERR_ORDER");
    assert.throws(() => library.output("bit_sped"), /bit_sped/);
});

test("a step that fails keeps the state", () => {
    const model = library.model();
    model.addPipes({}, 5);
    const wild = model.addTimeFunction([{ function: (time) => (time < 0.0105 ? 0 : 1e40), provides: 0 }]);
    const drive = model.addDrive({ component: c.RX, kind: c.DRIVE_LOAD, time_function: wild });
    model.compile({});
    const sim = model.sim();
    for (let i = 0; i < 10; i++) sim.step(1e-3);
    const hash = sim.hash();
    assert.equal(refusal(() => sim.step(1e-3)).statusName, "DMB_ERR_CALLBACK");
    assert.equal(sim.hash(), hash);
    assert.ok(Number.isFinite(sim.queryDrive(drive).speed));
});

test("an error of a function of JavaScript becomes the cause", () => {
    const model = library.model(), reason = new Error("no such time");
    const own = model.addTimeFunction([{ function: (time) => { if (time > 0.0015) throw reason; return 0; } }]);
    model.addPipes({}, 2);
    model.addDrive({ component: c.RX, kind: c.DRIVE_LOAD, time_function: own });
    model.compile({});
    const sim = model.sim();
    sim.step(1e-3);
    const error = refusal(() => sim.step(1e-3));
    assert.equal(error.statusName, "DMB_ERR_CALLBACK");
    assert.equal(error.cause, reason);
    assert.ok(Math.abs(sim.time - 1e-3) < 1e-15, "the sim is not busy for ever");
});

test("a scene larger than its memory is refused, and what was there goes on", async () => {
    const small = await load(undefined, { maximumMemory: 6 << 20 });
    const first = small.model();
    first.addPipes({}, 10);
    first.compile({});
    const sim = first.sim();
    sim.step(1e-3);
    const hash = sim.hash(), second = small.model();
    const error = refusal(() => {
        second.addPipes({}, 20000);
        second.compile({});
        second.sim();
    });
    assert.equal(error.statusName, "DMB_ERR_NO_MEMORY");
    assert.equal(sim.hash(), hash);
    sim.step(1e-3);
    assert.notEqual(sim.hash(), hash);
});

test("after a trap the library says so", async () => {
    const other = await load();
    assert.throws(() => other._run("dmb_wall_def_init", 2 ** 30, 1000), /stopped within wall_def_init/);
    assert.throws(() => other.model(), /load it again/);
    assert.match(other.broken, /load it again/);
});
