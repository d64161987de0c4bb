// The types, checked by tsc where it is installed: nothing runs.
import { constants as c, DrillError, Id, load, Pose, station, WallDef } from "drillmbd";

const library = await load(undefined, { maximumMemory: 1e8 });
const model = library.model();
const wall: Partial<WallDef> = { diameter: 0.094, survey: [0, 1.5, 0, 10, 1.5, 0] };
model.addWall(wall);
const string: Id = model.addString({ velocity: [0, 0, 0, 0, 0, 0] });
model.addPipes({ string, length: 3 }, 20);
const time_function = model.addTimeFunction([{ kind: c.SEGMENT_STEP5, h1: 10 }, { function: (time) => time }]);
model.addDrive({ component: c.RX, time_function });
model.compile();
const sim = model.sim({ bounded_work: 1 });
const status: number = sim.step(1e-3);
const pose: Pose = sim.queryPose(station(string, 0, 0.5));
const x: number = pose.position[0] + sim.profile([c.PROFILE_X], 3)[0];
sim.restore(sim.snapshot());
// @ts-expect-error a field that is not there
model.addWall({ diametre: 1 });
// @ts-expect-error a text for a number
model.addWall({ diameter: "94 mm" });
try {
    sim.step(-status - x);
} catch (error) {
    if (error instanceof DrillError) console.log(error.part, error.field, error.bound, sim.hash());
}
