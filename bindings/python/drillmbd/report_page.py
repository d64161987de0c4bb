"""The report as one self-contained HTML page: plotly.js is embedded, packed; the page needs no network."""
from __future__ import annotations

import base64
import gzip
import html
import json
from typing import Any, Protocol

from ._optional import need
from .answers import Output, finite
from .verdict import NEAR, NOT_ASSESSED, NOT_COMPUTED, OK, OVER, Tile

CLASSES = {OK: "ok", NEAR: "near", OVER: "over", NOT_ASSESSED: "open", NOT_COMPUTED: "open"}


class Content(Protocol):
    """The content of a page."""
    title: str
    headline: str
    output: Output
    tiles: list[Tile]
    figures: list[tuple[str, str, dict[str, Any]]]
    check: str

    def assumptions(self) -> list[tuple[str, str]]:
        """Pairs of a subject and its text."""


STYLE = """body{font:16px/1.45 sans-serif;max-width:1100px;margin:0 auto;padding:1em;color:#111}h1{font-size:1.5em}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(230px,1fr));gap:10px}
.card{border:2px solid #555;padding:10px}
.card b{display:block;font-size:1.5em}.card i{display:inline-block;font-style:normal;font-weight:bold;padding:0 .5em;border:1px solid #000}
.ok i{background:#cfe8d5}.near i{background:#ffe08a}.over{border:4px solid #000}.over i{background:#d55e00;color:#fff}.open{border-style:dashed}
.open i{background:#ddd}.figure{min-height:420px;width:100%}section{break-inside:avoid}
@media (max-width:600px){body{padding:.5em}.figure{min-height:300px}}
table{border-collapse:collapse}td,th{border:1px solid #999;padding:2px 8px;text-align:left}pre{overflow:auto;font-size:12px}
@media print{.figure{break-inside:avoid}h2{break-after:avoid}body{max-width:none}}"""

SCRIPT = """const problems=document.getElementById("problems");let failed=0;
function trouble(text){failed+=1;problems.textContent+=text+"\\n";problems.dataset.count=failed}
window.addEventListener("error",e=>trouble(e.message));
window.addEventListener("unhandledrejection",e=>trouble(String(e.reason)));
async function unpacked(id){const bytes=Uint8Array.from(atob(document.getElementById(id).textContent),c=>c.charCodeAt(0));
return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text()}
(async()=>{const script=document.createElement("script");
script.textContent=await unpacked("plotly");document.head.append(script);
const figures=JSON.parse(document.getElementById("figures").textContent);
const common={margin:{l:70,r:20,t:40,b:50},font:{size:14},legend:{orientation:"h",y:-0.25}};let drawn=0;
for(let i=0;i<figures.length;i++){const f=figures[i];
try{await Plotly.newPlot("figure"+i,f.data,{...common,...f.layout},{responsive:true,displaylogo:false});
if(f.frames)await Plotly.addFrames("figure"+i,f.frames);drawn+=1}catch(e){trouble(String(e))}}
document.body.dataset.drawn=drawn})();"""


def _tile(tile: Tile) -> str:
    escape = html.escape
    return (f'<div class="card {CLASSES.get(tile.verdict, "none")}">{escape(tile.title)}<b>{escape(tile.value)}</b>'
            f"<i>{escape(tile.verdict)}</i> {escape(tile.text)}</div>")


def page(study: Content) -> str:
    """The HTML of the page."""
    plotly = need("plotly.offline").get_plotlyjs()
    packed = base64.b64encode(gzip.compress(plotly.encode(), 9, mtime=0)).decode()
    figures = json.dumps(finite([figure for _, _, figure in study.figures]), separators=(",", ":")).replace("<", "\\u003c")
    escape = html.escape
    tiles = "".join(_tile(tile) for tile in study.tiles)
    drawn = "".join(f'<section><h2>{escape(title)}</h2><p>{escape(text)}</p><div class="figure" id="figure{number}"></div></section>'
                    for number, (title, text, _) in enumerate(study.figures))
    notes = "".join(f"<li>{escape(note)}</li>" for note in study.output.summary["notes"]) or "<li>none</li>"
    facts = "".join(f"<tr><th>{escape(key)}</th><td>{escape(value)}</td></tr>" for key, value in study.assumptions())
    title = escape(study.title or "Scene without a title")
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
            f'<meta name="viewport" content="width=device-width,initial-scale=1"><style>{STYLE}</style></head><body><h1>{title}</h1>'
            f'<p>{escape(study.headline)}</p><div class="cards">{tiles}</div><h2>Notes</h2>'
            f'<ul>{notes}</ul>{drawn}<h2>Assumptions</h2>'
            f'<table>{facts}</table><h2>Model check</h2><pre>{escape(study.check)}</pre>'
            f'<pre id="problems" data-count="0"></pre><script type="text/plain" id="plotly">{packed}</script>'
            f'<script type="application/json" id="figures">{figures}</script><script>{SCRIPT}</script></body></html>')
