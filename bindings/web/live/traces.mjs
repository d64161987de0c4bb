// Traces of outputs over time, one chart each: the value now, its limits, the last seconds.
import { word } from "./words.mjs";

const INK = "#111", GRID = "#c8c8c8", LIMIT = "#7a0019";

/** A round step that divides a range into about `parts`. */
export function niceStep(range, parts) {
    const raw = Math.max(range, 1e-12) / parts, power = 10 ** Math.floor(Math.log10(raw));
    return power * [1, 2, 5, 10].find((one) => one * power >= raw * 0.999);
}

export function shown(value) {
    if (!Number.isFinite(value)) return "-";
    const size = Math.abs(value);
    return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : size >= 0.1 || size === 0 ? 2 : 3);
}

export class Trace {
    constructor(place, trace, seconds) {
        Object.assign(this, { trace, seconds, rows: [] });
        place.innerHTML = `<h3></h3><p class="now"><b></b> <span></span></p><canvas></canvas>`;
        place.querySelector("h3").textContent = trace.title;
        this.place = place;
        this.canvas = place.querySelector("canvas");
        this.canvas.setAttribute("role", "img");
    }

    clear(from = -Infinity) {
        this.rows = this.rows.filter(([time]) => time <= from);
    }

    add(time, values) {
        this.rows.push([time, ...values.map((value) => value * this.trace.factor)]);
        while (this.rows.length > 2 && this.rows[0][0] < time - this.seconds) this.rows.shift();
    }

    /** The limit that the value is nearest to, or beyond, and its share of it. */
    nearest(value) {
        const found = this.trace.limits.map((limit) => ({ ...limit, share: value / limit.value })).filter((one) => one.share > 0);
        return found.sort((a, b) => b.share - a.share)[0];
    }

    show(values) {
        const value = values[0] * this.trace.factor, near = this.nearest(value), over = near && near.share > 1;
        this.place.querySelector("b").textContent = `${shown(value)} ${this.trace.unit}`;
        this.place.querySelector("span").textContent = !near ? "" : over ? word("OVER {limit}", { limit: near.text }) : word("{share} % of {limit}", { share: (100 * near.share).toFixed(0), limit: near.text });
        this.place.classList.toggle("over", Boolean(over));
        this.canvas.setAttribute("aria-label", `${this.trace.title}: ${shown(value)} ${this.trace.unit}`);
    }

    /** The range of the axis: what is drawn, 0, and limits that are not far off. */
    range() {
        const all = this.rows.flatMap((row) => row.slice(1)).filter(Number.isFinite);
        let low = Math.min(0, ...all), high = Math.max(0, ...all);
        for (const { value } of this.trace.limits) {
            if (value > 0 && high > 0.15 * value) high = Math.max(high, value);
            if (value < 0 && low < 0.15 * value) low = Math.min(low, value);
        }
        if (high - low < this.trace.least) high = low + this.trace.least;
        return [low - (low < 0 ? 0.06 : 0) * (high - low), high + 0.12 * (high - low)];
    }

    draw() {
        const scale = globalThis.devicePixelRatio || 1, wide = this.canvas.clientWidth, tall = this.canvas.clientHeight;
        if (!wide || !tall) return;
        if (this.canvas.width !== Math.round(wide * scale)) this.canvas.width = Math.round(wide * scale);
        if (this.canvas.height !== Math.round(tall * scale)) this.canvas.height = Math.round(tall * scale);
        const pen = this.canvas.getContext("2d");
        pen.setTransform(scale, 0, 0, scale, 0, 0);
        pen.clearRect(0, 0, wide, tall);
        const left = 44, right = wide - 6, top = 4, bottom = tall - 16, [low, high] = this.range();
        const end = this.rows.length ? this.rows[this.rows.length - 1][0] : 0, begin = Math.max(0, end - this.seconds);
        const span = Math.max(end - begin, 1);
        const x = (time) => left + ((time - begin) / span) * (right - left), y = (value) => bottom - ((value - low) / (high - low)) * (bottom - top);
        this.axes(pen, { left, right, top, bottom, low, high, begin, span, x, y });
        this.limits(pen, { left, right, top, bottom, low, high, y });
        pen.save();
        pen.beginPath();
        pen.rect(left, top, right - left, bottom - top);
        pen.clip();
        for (let k = this.trace.lines.length; k >= 1; k--) this.line(pen, k, x, y);
        pen.restore();
    }

    axes(pen, { left, right, top, bottom, low, high, begin, span, x, y }) {
        pen.font = "11px system-ui, sans-serif";
        pen.fillStyle = INK;
        pen.strokeStyle = GRID;
        pen.lineWidth = 1;
        const rise = niceStep(high - low, 4), stride = niceStep(span, 5);
        pen.textAlign = "right";
        pen.textBaseline = "middle";
        for (let value = Math.ceil(low / rise) * rise; value <= high; value += rise) {
            pen.beginPath();
            pen.moveTo(left, y(value));
            pen.lineTo(right, y(value));
            pen.stroke();
            pen.fillText(String(Number(value.toPrecision(6))), left - 4, Math.max(top + 6, y(value)));
        }
        pen.textAlign = "center";
        pen.textBaseline = "alphabetic";
        for (let time = Math.ceil(begin / stride) * stride; time <= begin + span * 1.0001; time += stride)
            pen.fillText(`${Number(time.toPrecision(6))} s`, Math.min(Math.max(x(time), left + 10), right - 12), bottom + 13);
        pen.strokeStyle = INK;
        pen.strokeRect(left, top, right - left, bottom - top);
    }

    /** Limits as dashed lines with their names; one beyond the axis as an arrow at its edge. */
    limits(pen, { left, right, top, bottom, low, high, y }) {
        pen.textAlign = "left";
        for (const { value, text } of this.trace.limits) {
            const inside = value >= low && value <= high, level = inside ? y(value) : value > 0 ? top + 1 : bottom - 1;
            if (!inside && value < 0 && low >= 0) continue; // a limit of a pull where nothing pulls
            pen.strokeStyle = pen.fillStyle = LIMIT;
            pen.lineWidth = inside ? 2 : 1;
            pen.setLineDash(inside ? [7, 4] : [2, 4]);
            pen.beginPath();
            pen.moveTo(left, level);
            pen.lineTo(right, level);
            pen.stroke();
            pen.setLineDash([]);
            pen.strokeStyle = "#fff";
            pen.lineWidth = 3;
            pen.strokeText(inside ? text : `${text} ${value > 0 ? "↑" : "↓"}`, left + 4, value > 0 ? level + 12 : level - 5);
            pen.fillText(inside ? text : `${text} ${value > 0 ? "↑" : "↓"}`, left + 4, value > 0 ? level + 12 : level - 5);
        }
    }

    line(pen, k, x, y) {
        pen.strokeStyle = k === 1 ? INK : "#666";
        pen.lineWidth = k === 1 ? 1.6 : 1.2;
        pen.setLineDash(k === 1 ? [] : [4, 3]);
        pen.beginPath();
        this.rows.forEach((row, i) => (i ? pen.lineTo(x(row[0]), y(row[k])) : pen.moveTo(x(row[0]), y(row[k]))));
        pen.stroke();
        pen.setLineDash([]);
    }
}
