// The string in its hole in three dimensions: WebGL where there is one, lines on a 2D canvas else. Distances across the axis of the hole
// are drawn `exaggeration` times as large as those along it.
import { word } from "./words.mjs";

const SIDES = 14, RINGS = 48, LONGITUDINAL = 12;
const RESTORED = 2000; // [ms] within which a browser restores a lost context

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (a) => {
    const size = Math.hypot(...a) || 1;
    return [a[0] / size, a[1] / size, a[2] / size];
};

/** Columns: pale where nothing touches, dark where the contact force is at its largest; lightness falls all the way. */
export function shade(share) {
    const s = Math.min(Math.max(share, 0), 1) ** 0.6;
    return [0.93 - 0.62 * s, 0.7 - 0.62 * s, 0.32 - 0.25 * s];
}

/** Two unit vectors across a tangent: to the side and up. */
function across(tangent) {
    const side = Math.abs(tangent[2]) > 0.999 ? [0, 1, 0] : unit(cross([0, 0, 1], tangent));
    return [side, cross(tangent, side)];
}

export class Camera {
    constructor() {
        Object.assign(this, { turn: -0.9, rise: 0.35, length: 10, centre: [0, 0, 0] });
    }

    /** Axes of the picture in the world (right, up, towards the eye) and pixels a metre. */
    axes(wide, tall) {
        const eye = [Math.cos(this.rise) * Math.cos(this.turn), Math.cos(this.rise) * Math.sin(this.turn), Math.sin(this.rise)];
        const right = unit(cross([0, 0, 1], eye)), up = cross(eye, right);
        return { right, up, eye, scale: Math.min(wide, 1.8 * tall) / this.length };
    }
}

export class View {
    constructor(place, report) {
        Object.assign(this, { place, report, camera: new Camera(), exaggeration: 1, force: 1 });
        this.canvas = place.querySelector("canvas");
        this.canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault(); // asks for it to be restored, which a browser does at once or never
            setTimeout(() => this.gl?.isContextLost() && this.flat(), RESTORED);
        });
        this.canvas.addEventListener("webglcontextrestored", () => (this.setUp(this.gl) ? this.report("") : this.flat()));
        this.gl = this.begin3();
        if (!this.gl) this.flat();
    }

    /** Lines on a 2D canvas. A canvas that had a context of WebGL has no other, so a new one takes its place. */
    flat() {
        this.gl = null;
        this.pen = this.canvas.getContext("2d");
        if (!this.pen) {
            const other = this.canvas.cloneNode();
            this.canvas.replaceWith(other);
            Object.assign(this, { canvas: other, pen: other.getContext("2d") });
        }
        this.report(word("This browser has no WebGL: the string is drawn as lines."));
    }

    begin3() {
        if (globalThis.location?.hash.includes("2d")) return null;
        const gl = this.canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
        return gl && this.setUp(gl) ? gl : null;
    }

    setUp(gl) {
        const program = gl.createProgram();
        const source = {
            VERTEX_SHADER: `attribute vec3 at; attribute vec3 normal; attribute vec3 colour; uniform vec3 right, up, eye, centre; uniform vec2 scale; uniform float depth;
                varying vec3 shown; void main() { vec3 p = at - centre; gl_Position = vec4(dot(p, right) * scale.x, dot(p, up) * scale.y, -dot(p, eye) * depth, 1.0);
                float light = length(normal) < 0.5 ? 1.0 : 0.42 + 0.58 * max(0.0, dot(normalize(normal), normalize(eye + 0.6 * up + 0.3 * right)));
                shown = colour * light; }`,
            FRAGMENT_SHADER: "precision mediump float; varying vec3 shown; void main() { gl_FragColor = vec4(shown, 1.0); }",
        };
        for (const [kind, text] of Object.entries(source)) {
            const shader = gl.createShader(gl[kind]);
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
        }
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return false;
        gl.useProgram(program);
        this.program = program;
        this.buffers = { mesh: gl.createBuffer(), lines: gl.createBuffer(), index: gl.createBuffer() };
        this.indexed = 0;
        return true;
    }

    /** Rings of all strings, one string behind the other: first and last ring of its string and radius [m] of each, the ring before it that it
     * continues (-1: none), and the ring at the bit. */
    setStrings(strings, withBit) {
        const rings = [];
        this.lasts = [];
        for (const { stations, length, radii, continues } of strings) {
            const first = rings.length, last = first + stations - 1;
            for (let i = first; i <= last; i++) {
                const at = ((i - first) / (stations - 1)) * length, run = radii.find((one) => at <= one.end * (1 + 1e-9)) ?? radii[radii.length - 1];
                rings.push({ first, last, radius: run.radius, before: i > first ? i - 1 : continues === null ? -1 : this.lasts[continues] });
            }
            this.lasts.push(last);
        }
        this.rings = rings;
        this.bitRing = this.lasts[withBit];
    }

    /** The axis of the hole of a scene that begins: points [m], radii [m] or null. */
    setLine({ points, radii }) {
        const every = Math.max(1, Math.floor(points.length / 3 / (radii ? 400 : 200)));
        this.line = [];
        for (let i = 0; i < points.length / 3; i += every) // of a scene without hole the strings themselves, with gaps between them
            this.line.push({ at: [...points.slice(3 * i, 3 * i + 3)], radius: radii?.[i] ?? 0, gap: !radii && i > 0 && this.rings[i].first > i - every && this.rings[this.rings[i].first].before < 0 });
        this.frames = this.line.map((one, i) => {
            const before = this.line[Math.max(i - 1, 0)].at, after = this.line[Math.min(i + 1, this.line.length - 1)].at;
            return across(unit(sub(after, before)));
        });
        this.wholeLength = Math.hypot(...sub(this.line[this.line.length - 1].at, this.line[0].at));
    }

    /** [-] that shows the hole about a fourteenth as wide as the picture is long; without a hole, which bounds what strings do, 1. */
    usualExaggeration() {
        const { radius } = this.line[0];
        return radius ? Math.max(1, this.camera.length / 28 / radius) : 1;
    }

    /** Looks at the whole string, or at one end of it. */
    lookAt(where) {
        const first = this.line[0].at, last = this.line[this.line.length - 1].at, { camera } = this;
        this.where = where;
        const along = unit(sub(last, first));
        if (where === "whole") {
            camera.centre = first.map((x, k) => 0.5 * (x + last[k]));
            camera.length = 1.12 * this.wholeLength;
        } else {
            camera.length = Math.min(12, this.wholeLength);
            const from = where === "bit" ? this.tip ?? last : first, sign = where === "bit" ? -0.4 : 0.4;
            camera.centre = from.map((x, k) => x + sign * camera.length * along[k]);
        }
        const level = Math.hypot(along[0], along[1]) > 0.05;
        if (level && !this.aimed) camera.turn = Math.atan2(along[1], along[0]) - Math.PI / 2 + 0.35;
        this.aimed = true;
    }

    /** The state of a moment. */
    setFrame({ base, offset, turn, force }) {
        Object.assign(this, { base, offset, turn, loads: force });
        const last = 3 * this.bitRing;
        this.tip = this.line[0].radius ? [base[last], base[last + 1], base[last + 2]] : this.point(this.bitRing);
        if (this.where === "bit" && this.followed) this.camera.centre = this.camera.centre.map((x, k) => x + this.tip[k] - this.followed[k]);
        this.followed = this.tip;
        let most = 0;
        for (const one of force) if (one > most) most = one;
        this.force = Math.max(most, 0.995 * this.force, 1);
    }

    point(i) {
        const k = this.exaggeration;
        return [0, 1, 2].map((x) => this.base[3 * i + x] + k * this.offset[3 * i + x]);
    }

    draw() {
        if (!this.base || !this.line) return;
        const ratio = globalThis.devicePixelRatio || 1;
        const wide = Math.max(1, Math.round(this.canvas.clientWidth * ratio)), tall = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
        if (this.canvas.width !== wide) this.canvas.width = wide;
        if (this.canvas.height !== tall) this.canvas.height = tall;
        const axes = this.camera.axes(wide, tall);
        if (this.gl && !this.gl.isContextLost()) this.draw3(axes, wide, tall);
        else if (this.pen) this.draw2(axes, wide, tall);
        this.label(axes, wide / ratio, tall / ratio, ratio);
    }

    // ---- WebGL ------------------------------------------------------------------------------------------------------------------------
    draw3({ right, up, eye, scale }, wide, tall) {
        const { gl, program, camera } = this;
        gl.viewport(0, 0, wide, tall);
        gl.clearColor(1, 1, 1, 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        gl.enable(gl.DEPTH_TEST);
        const at = (name) => gl.getUniformLocation(program, name);
        const centre = camera.centre;
        gl.uniform3fv(at("right"), right);
        gl.uniform3fv(at("up"), up);
        gl.uniform3fv(at("eye"), eye);
        gl.uniform3fv(at("centre"), [0, 0, 0]); // meshes are relative to it already: floats of 32 bits
        gl.uniform2fv(at("scale"), [(2 * scale) / wide, (2 * scale) / tall]);
        gl.uniform1f(at("depth"), 0.5 / Math.max(this.wholeLength, camera.length));
        const mesh = this.tube(centre), lines = this.holeLines(centre);
        this.send(this.buffers.lines, lines);
        gl.drawArrays(gl.LINES, 0, lines.length / 9);
        this.send(this.buffers.mesh, mesh);
        gl.drawElements(gl.TRIANGLES, this.index(), gl.UNSIGNED_SHORT, 0);
    }

    send(buffer, data) {
        const { gl, program } = this;
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
        ["at", "normal", "colour"].forEach((name, k) => {
            const place = gl.getAttribLocation(program, name);
            gl.enableVertexAttribArray(place);
            gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 36, 12 * k);
        });
    }

    /** Triangles between neighbouring rings of the tube. */
    index() {
        const { gl } = this, ends = this.rings.map((one, i) => [one.before, i]).filter(([before]) => before >= 0), count = ends.length * SIDES * 6;
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers.index);
        if (this.indexed !== count) {
            const data = new Uint16Array(count);
            let n = 0;
            for (const [from, to] of ends) {
                for (let k = 0; k < SIDES; k++) {
                    const next = (k + 1) % SIDES, a = from * SIDES, b = to * SIDES;
                    data.set([a + k, a + next, b + k, a + next, b + next, b + k], n);
                    n += 6;
                }
            }
            gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, data, gl.STATIC_DRAW);
            this.indexed = count;
        }
        return count;
    }

    /** Rings of the string: place, normal and colour of each corner; two sides are pale and show how far the string has turned. */
    tube(centre) {
        const rings = this.base.length / 3, data = new Float32Array(rings * SIDES * 9);
        for (let i = 0, n = 0; i < rings; i++) {
            const { first, last, radius: thick } = this.rings[i], here = this.point(i), on = (k) => this.base.subarray(3 * k, 3 * k + 3);
            const [side, upward] = across(unit(sub(on(Math.min(i + 1, last)), on(Math.max(i - 1, first))))), radius = this.exaggeration * thick, colour = shade(this.loads[i] / this.force);
            for (let k = 0; k < SIDES; k++, n += 9) {
                const angle = (2 * Math.PI * k) / SIDES + this.turn[i], c = Math.cos(angle), s = Math.sin(angle), stripe = k % 7 < 2;
                for (let x = 0; x < 3; x++) {
                    const normal = c * side[x] + s * upward[x];
                    data[n + x] = here[x] - centre[x] + radius * normal;
                    data[n + 3 + x] = normal;
                    data[n + 6 + x] = stripe ? 0.45 + 0.55 * colour[x] : colour[x];
                }
            }
        }
        return data;
    }

    /** The hole as rings and lines along it. */
    holeLines(centre) {
        const found = [], k = this.exaggeration, grey = [0.62, 0.66, 0.7];
        const corner = (i, turn) => {
            const { at, radius } = this.line[i], [side, upward] = this.frames[i], c = k * radius * Math.cos(turn), s = k * radius * Math.sin(turn);
            return at.map((x, j) => x + c * side[j] + s * upward[j] - centre[j]);
        };
        const put = (a, b) => found.push(...a, 0, 0, 0, ...grey, ...b, 0, 0, 0, ...grey);
        const lines = this.line[0].radius ? LONGITUDINAL : 1, last = this.line.length - 1;
        for (let j = 0; j < lines; j++) for (let i = 0; i < last; i++) if (!this.line[i + 1].gap) put(corner(i, (2 * Math.PI * j) / lines), corner(i + 1, (2 * Math.PI * j) / lines));
        const spacing = Math.max(1, Math.round((last * Math.min(1, this.camera.length / this.wholeLength)) / 12));
        if (lines > 1) for (let i = 0; i <= last; i += spacing) for (let j = 0; j < RINGS; j++) put(corner(i, (2 * Math.PI * j) / RINGS), corner(i, (2 * Math.PI * (j + 1)) / RINGS));
        return new Float32Array(found);
    }

    // ---- 2D ---------------------------------------------------------------------------------------------------------------------------
    draw2({ right, up, scale }, wide, tall) {
        const { pen, camera, line, frames } = this, k = this.exaggeration;
        const flat = (p) => {
            const d = sub(p, camera.centre);
            return [0.5 * wide + scale * dot(d, right), 0.5 * tall - scale * dot(d, up)];
        };
        pen.fillStyle = "#fff";
        pen.fillRect(0, 0, wide, tall);
        pen.lineCap = "butt";
        const path = (points, colour, width, gaps = []) => {
            pen.strokeStyle = colour;
            pen.lineWidth = width;
            pen.beginPath();
            points.forEach((p, i) => (i && !gaps[i] ? pen.lineTo(...p) : pen.moveTo(...p)));
            pen.stroke();
        };
        for (let j = 0; j < LONGITUDINAL; j++) {
            const turn = (2 * Math.PI * j) / LONGITUDINAL;
            path(line.map(({ at, radius }, i) => flat(at.map((x, n) => x + k * radius * (Math.cos(turn) * frames[i][0][n] + Math.sin(turn) * frames[i][1][n])))), "#aab", 1, line.map((one) => one.gap));
        }
        const rings = this.base.length / 3, points = Array.from({ length: rings }, (_, i) => flat(this.point(i)));
        this.rings.forEach(({ before, radius }, i) => {
            if (before < 0) return;
            const [r, g, b] = shade(this.loads[before] / this.force).map((x) => Math.round(255 * x));
            path([points[before], points[i].map((x, j) => x + 0.1 * (x - points[before][j]))], `rgb(${r},${g},${b})`, Math.max(2, 2 * scale * k * radius));
        });
    }

    // ---- Words ------------------------------------------------------------------------------------------------------------------------
    label({ right, up, scale }, wide, tall, ratio) {
        const put = (name, at) => {
            const d = sub(at, this.camera.centre), tag = this.place.querySelector(`.${name}`);
            const x = 0.5 * wide + (scale / ratio) * dot(d, right), y = 0.5 * tall - (scale / ratio) * dot(d, up) - 12;
            const inside = x > -5 && x < wide + 5 && y > 0 && y < tall;
            tag.hidden = !inside;
            tag.style.left = `${Math.min(Math.max(x, 16), wide - 16)}px`;
            tag.style.top = `${Math.min(Math.max(y, 14), tall - 14)}px`;
        };
        const across = 1.1 * this.exaggeration * (this.line[0].radius || 0.05);
        put("rig", this.line[0].at.map((x, k) => x + across * up[k]));
        put("bit", this.tip.map((x, k) => x + across * up[k]));
    }
}
