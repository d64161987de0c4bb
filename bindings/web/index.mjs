// The package: the library from the file beside this one, from a URL, or from bytes.
import { instantiate } from "./drillmbd.mjs";

export { constants, DrillError, instantiate, Model, Sim, station } from "./drillmbd.mjs";

/** The library. source: bytes, a WebAssembly.Module or a URL; left out: drillmbd.wasm beside this file. */
export async function load(source, options) {
    if (source === undefined || typeof source === "string" || source instanceof URL)
        source = await bytesOf(new URL(source ?? "./drillmbd.wasm", import.meta.url));
    return instantiate(source, options);
}

async function bytesOf(url) {
    if (url.protocol === "file:" && globalThis.process?.versions?.node) return (await import("node:fs/promises")).readFile(url);
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}; give load() the address of drillmbd.wasm`);
    return answer.arrayBuffer();
}
