// The package: the library from the files beside this one, from a URL, or from bytes.
import { compiled, instantiate } from "./drillmbd.mjs";

export { compiled, constants, DrillError, instantiate, Model, Sim, station } from "./drillmbd.mjs";

const FILES = ["./drillmbd_simd.wasm", "./drillmbd.wasm"]; // for engines with SIMD, and for all

/** The library. source: bytes, a WebAssembly.Module or a URL; left out: the first file beside this one that the engine can run. */
export async function load(source, options) {
    return instantiate(source === undefined ? await ownModule() : typeof source === "string" || source instanceof URL ? await bytesOf(new URL(source, import.meta.url)) : source, options);
}

/** The file for all engines is read only where that with SIMD cannot run. */
async function ownModule() {
    const [wide, plain] = FILES.map((name) => new URL(name, import.meta.url));
    try {
        return await WebAssembly.compile(await bytesOf(wide));
    } catch (error) {
        if (!(error instanceof WebAssembly.CompileError)) throw error;
        return WebAssembly.compile(await bytesOf(plain));
    }
}

async function bytesOf(url) {
    if (url.protocol === "file:" && globalThis.process?.versions?.node) return (await import("node:fs/promises")).readFile(url);
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}; give load() the address of drillmbd.wasm`);
    return answer.arrayBuffer();
}
