"""The report as one self-contained HTML page: plotly.js is embedded, packed; the page needs no network."""
from __future__ import annotations

import base64
import gzip
import html
import json
from collections.abc import Iterable
from typing import Protocol

from ._optional import need
from .results import CommandOutput, finite
from .language import joined, phrase
from .report_basis import Row
from .report_figures import Figure, InSpace
from .report_hole import Drawing, HoleView, still
from .verdict import NEAR, NOT_ASSESSED, NOT_COMPUTED, OK, OVER, WORST_FIRST, Tile

CLASSES: dict[str, str] = {OK: "ok", NEAR: "near", OVER: "over", NOT_ASSESSED: "open", NOT_COMPUTED: "open"}
WIDE, NARROW = 960.0, 340.0  #: [pixel] pictures of the hole for screens and paper, and for phones


class Content(Protocol):
    """The content of a page."""
    title: str
    headline: str
    made: str
    out: CommandOutput
    tiles: list[Tile]
    rows: list[Row]
    understood: list[str]
    hole: HoleView | None
    space: InSpace | None
    figures: list[Figure]
    check: str  #: in SI
    live: str  #: packed page that runs the scene; "": none

    def assumptions(self) -> list[tuple[str, str]]:
        """Pairs of a subject and its text."""


STYLE = """body,.card{box-sizing:border-box}body{font:16px/1.45 system-ui,"Noto Sans","Noto Sans CJK SC","Microsoft YaHei","PingFang SC","WenQuanYi Micro Hei",sans-serif;
max-width:1100px;margin:0 auto;padding:1em;color:#111;background:#fff;overflow-wrap:break-word}
h1{font-size:1.5em;margin:.3em 0}h2{font-size:1.2em;margin:1.4em 0 .4em}.made{color:#444;margin:0}
.cards{display:grid;grid-template-columns:repeat(auto-fill,minmax(230px,1fr));gap:10px}
.card{border:2px solid #555;padding:10px;break-inside:avoid}
.card b{display:block;font-size:1.3em;line-height:1.25}
.verdict{display:inline-block;font-style:normal;font-weight:bold;padding:0 .5em;border:1px solid #000;white-space:nowrap}
.ok .verdict{background:#cfe8d5}.near .verdict{background:#ffe08a}.card.over{border:4px solid #000}.over .verdict{background:#b3261e;color:#fff}
.card.open{border-style:dashed}.open .verdict{background:#ddd}
.figure{min-height:420px;width:100%}.still{display:none}.wide svg,.narrow svg,.still svg{max-width:100%;height:auto;display:block}.narrow{display:none}
#start{font:inherit;padding:.5em 1.2em;min-height:44px;font-weight:bold;background:#1d3557;color:#fff;border:1px solid #000}#live{width:100%;height:92vh;border:1px solid #555}
.scroll{overflow-x:auto;max-width:100%}table{border-collapse:collapse}td,th{border:1px solid #999;padding:3px 8px;text-align:left;vertical-align:top}
pre{overflow:auto;font-size:12px}.nogl .turning{display:none}.nogl .still{display:block}
@media screen and (max-width:600px){body{padding:.6em}.figure{min-height:300px}.wide{display:none}.narrow{display:block}
.limits td,.limits th{padding:3px 4px;font-size:13px}.limits tr:first-child th{font-size:12px}.limits{table-layout:fixed;width:100%}.limits .verdict{white-space:normal;padding:0 .2em;font-size:11px}
.limits th:first-child{width:18%}.limits th:nth-child(2){width:28%}.limits th:nth-child(4){width:23%}}
@page{size:A4;margin:15mm}
@media print{body{max-width:none;padding:0;font-size:10pt;line-height:1.3}h2{margin:1em 0 .3em}.modebar-container{display:none}h1,h2,h2+p{break-after:avoid}section,.card,tr,.wide,.still{break-inside:avoid}
.cards{grid-template-columns:repeat(3,1fr)}.figure{min-height:0}.turning,.screen{display:none}.still{display:block}.scroll{overflow:visible}pre{white-space:pre-wrap;overflow:visible}
.verdict{-webkit-print-color-adjust:exact;print-color-adjust:exact}}"""  # noqa: E501

SCRIPT = """const problems=document.getElementById("problems");let failed=0;
function trouble(text){failed+=1;problems.textContent+=text+"\\n";problems.dataset.count=failed}
window.addEventListener("error",e=>trouble(e.message));
window.addEventListener("unhandledrejection",e=>trouble(String(e.reason)));
async function unpacked(id){const bytes=Uint8Array.from(atob(document.getElementById(id).textContent),c=>c.charCodeAt(0));
return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text()}
const words=JSON.parse(document.getElementById("words").textContent),small=innerWidth<600,paper=660;
function fitted(f){const common={xaxis:{},yaxis:{},margin:{l:small?55:70,r:small?10:20,t:small?20:40,b:50},font:{size:small?12:14,family:getComputedStyle(document.body).fontFamily},
legend:{orientation:"h",x:0,y:1.02,yanchor:"bottom"}},l=f.layout,out={...common,...l,legend:{...common.legend,...l.legend}};
if(!l.scene){out.xaxis={automargin:true,...l.xaxis};out.yaxis={automargin:true,...l.yaxis}}
if(small&&l.scene){const eye=l.scene.camera.eye,box=l.scene.aspectratio,far=box.z>box.x+box.y?1.1:1.8;out.height=440;out.scene={...l.scene,camera:{eye:{x:far*eye.x,y:far*eye.y,z:far*eye.z}}};out.legend.y=-0.45;
for(const name of ["xaxis","yaxis","zaxis"])out.scene[name]={...l.scene[name],nticks:Math.min(4,l.scene[name].nticks)};
if(out.sliders)out.sliders=out.sliders.map(s=>({...s,font:{size:10},minorticklen:0}));
out.updatemenus=out.updatemenus.map((m,i)=>({...m,font:{size:11},pad:{l:0,r:0},x:0,y:i?1.0:1.14}))}return out}
const start=document.getElementById("start");
if(start)start.onclick=async()=>{const frame=document.getElementById("live");start.disabled=true;frame.hidden=false;frame.srcdoc=await unpacked("livepage");frame.onload=()=>{start.hidden=true;frame.focus()}};
(async()=>{const script=document.createElement("script");
script.textContent=await unpacked("plotly");document.head.append(script);
if(Object.keys(words).length)Plotly.register({moduleType:"locale",name:"page",dictionary:words,format:{}});
const figures=JSON.parse(document.getElementById("figures").textContent);let drawn=0;
if(!document.createElement("canvas").getContext("webgl"))document.body.classList.add("nogl");
const settings={responsive:true,displaylogo:false,displayModeBar:small?false:"hover",...(Object.keys(words).length?{locale:"page"}:{})};
for(let i=0;i<figures.length;i++){const f=figures[i];
try{await Plotly.newPlot("figure"+i,f.data,fitted(f),settings);
if(f.frames)await Plotly.addFrames("figure"+i,f.frames);drawn+=1}catch(e){trouble(String(e))}}
const flat=figures.map((f,i)=>i).filter(i=>!figures[i].layout.scene);
addEventListener("beforeprint",()=>flat.forEach(i=>Plotly.relayout("figure"+i,{width:paper,height:340})));
addEventListener("afterprint",()=>flat.forEach(i=>Plotly.relayout("figure"+i,{autosize:true,width:null,height:null})));
document.body.dataset.drawn=drawn})();"""  # noqa: E501

#: Words of plotly's own buttons.
BUTTONS = (phrase("Download plot as a PNG"), phrase("Zoom"), phrase("Pan"), phrase("Zoom in"), phrase("Zoom out"),
           phrase("Autoscale"), phrase("Reset axes"),
           phrase("Orbital rotation"), phrase("Turntable rotation"), phrase("Reset camera to default"),
           phrase("Reset camera to last save"),
           phrase("Double-click to zoom back out"), phrase("Taking snapshot - this may take a few seconds"),
           phrase("Snapshot succeeded"))


class Page:
    """Writes the parts of a page in one language."""

    def __init__(self, study: Content) -> None:
        self.study, self.to = study, study.out.language

    def text(self, sentence: str) -> str:
        """In the language of the page, as HTML."""
        return html.escape(self.to(sentence))

    def heading(self, title: str) -> str:
        """Of a section."""
        return f"<h2>{self.text(title)}</h2>"

    def tile(self, tile: Tile) -> str:
        """A card with the verdict in colour and in words."""
        return (f'<div class="card {CLASSES.get(tile.verdict, "none")}">{self.text(tile.title)}'
                f'<b>{self.text(tile.value)}</b>'
                f'<span class="verdict">{self.text(tile.verdict)}</span> {self.text(tile.text)}</div>')

    def verdicts(self) -> str:
        """One line for each verdict that occurs, the worst first."""
        found = []
        for verdict in WORST_FIRST:
            titles = [self.to(tile.title) for tile in self.study.tiles if tile.verdict == verdict]
            if titles:
                found.append(f'<div class="{CLASSES.get(verdict, "none")}"><span '
                             f'class="verdict">{self.text(verdict)}</span> '
                             f'{html.escape(self.to(phrase(", ")).join(titles))}</div>')
        return "".join(found)

    def limits(self) -> str:
        """The table of limits for the crew."""
        heads = (phrase("Quantity"), phrase("Do not exceed"), phrase("Expected"), phrase("Verdict"))
        rows = "".join(f'<tr class="{CLASSES.get(verdict, "none")}"><th>{self.text(title)}</th>'
                       f'<td><b>{self.text(limit)}</b></td><td>{self.text(expected)}</td>'
                       f'<td><span class="verdict">{self.text(verdict)}</span></td></tr>'
                       for title, limit, expected, verdict in self.study.rows)
        over = [tile.title for tile in self.study.tiles if tile.verdict == OVER]
        warning = phrase("Do not drill as described here. Over the limit: {quantities}.", quantities=joined(", ", over))
        stop = f'<p><b>{self.text(warning)}</b></p>' if over else ""
        return (self.heading(phrase("Limits that must not be exceeded")) + stop
                + '<div class="scroll"><table class="limits"><tr>'
                + "".join(f"<th>{self.text(head)}</th>" for head in heads) + f"</tr>{rows}</table></div><p>"
                + self.text(phrase("These values hold for this hole, string, mud and friction only. Stop and ask "
                                   "before a longer hole, another bit, or more "
                                   "than a value of this table. A quantity without the verdict OK is not cleared. If a "
                                   "reading is far from the expected "
                                   "value, this page does not describe the hole: stop and ask.")) + "</p>")

    def hole(self) -> str:
        """Hole and string in words, plan and section."""
        words = "".join(f"<li>{self.text(one)}</li>" for one in self.study.understood)
        found = f'{self.heading(phrase("Hole, string and operation"))}<ul>{words}</ul>'
        if self.study.hole is None:
            return found
        drawn = "".join(f'<div class="{name}">{Drawing(self.study.hole, width, self.to).svg()}</div>'
                        for name, width in (("wide", WIDE), ("narrow", NARROW)))
        about = phrase("To scale. Thicker and darker is a larger contact force: the normal force per length on the "
                       "wall of the stiff string in the static "
                       "equilibrium at time 0 s, the largest of each pipe.")
        return (f'{found}<section><h2>{self.text(phrase("Plan and section"))}</h2>'
                f'<p>{self.text(about)}</p>{drawn}</section>')

    def live(self) -> str:
        """The page that runs the scene, in a frame that is empty until the reader starts it; nothing on paper."""
        if not self.study.live:
            return ""
        about = phrase("Change rotation, feed, load on the bit, friction and diameter of the hole, and see how torque, "
                       "thrust, bit speed and contact "
                       "respond. The values above do not change: they hold for the scene as it is described.")
        return (f'<section class="screen">{self.heading(phrase("Run the scene"))}<p>{self.text(about)}</p>'
                f'<p><button id="start">{self.text(phrase("Start"))}</button></p><iframe id="live" '
                f'title="{self.text(phrase("Run the scene"))}" hidden></iframe>'
                f'<script type="text/plain" id="livepage">{self.study.live}</script></section>')

    def figure(self, number: int, figure: Figure) -> str:
        """Heading, text and figure stay together; the view in space has a still picture for paper."""
        title, text, drawn = figure
        inside = f'<div class="figure" id="figure{number}"></div>'
        space = self.study.space
        if "scene" in drawn.get("layout", {}) and space is not None:
            picture = still(space.axis, space.drawn(len(space.shapes) - 1, space.factor), space.radius, space.factor,
                            self.to)
            return (f'<section><h2>{self.text(title)}</h2><p class="turning">{self.text(text)}</p><div '
                    f'class="turning">{inside}</div>'
                    f'<div class="still">{picture}</div></section>')
        return f"<section><h2>{self.text(title)}</h2><p>{self.text(text)}</p>{inside}</section>"

    def data(self, name: str, value: object) -> str:
        """JSON for the script."""
        packed = json.dumps(finite(value), separators=(",", ":"), ensure_ascii=False).replace("<", "\\u003c")
        return f'<script type="application/json" id="{name}">{packed}</script>'

    def items(self, sentences: Iterable[str]) -> str:
        """A list, of one "none" at least."""
        return "<ul>" + ("".join(f"<li>{self.text(one)}</li>" for one in sentences)
                         or f"<li>{self.text(phrase('none'))}</li>") + "</ul>"


def page(study: Content) -> str:
    """The HTML of the page."""
    made = Page(study)
    packed = base64.b64encode(gzip.compress(need("plotly.offline").get_plotlyjs().encode(), 9, mtime=0)).decode()
    words = {} if made.to.name == "en" else {str(one): made.to(one) for one in BUTTONS}
    title = made.text(study.title or phrase("Scene without a title"))
    facts = "".join(f"<tr><th>{made.text(key)}</th><td>{made.text(value)}</td></tr>"
                    for key, value in study.assumptions())
    return (f'<!doctype html><html lang="{made.to.tag}"><head><meta charset="utf-8"><title>{title}</title>'
            '<meta name="viewport" '
            f'content="width=device-width,initial-scale=1"><style>{STYLE}</style></head><body><h1>{title}</h1>'
            f'<p class="made">{made.text(study.made)}</p><p>{made.text(study.headline)}</p>'
            f'{made.verdicts()}{made.limits()}'
            f'{made.heading(phrase("Results against limits"))}<div '
            f'class="cards">{"".join(made.tile(tile) for tile in study.tiles)}</div>'
            f'{made.hole()}{made.live()}{made.heading(phrase("Notes"))}'
            f'{made.items([*study.out.summary["warnings"], *study.out.summary["notes"]])}'
            + "".join(made.figure(number, one) for number, one in enumerate(study.figures))
            + f'{made.heading(phrase("Assumptions"))}<div '
              f'class="scroll"><table>{facts}</table></div>{made.heading(phrase("Model check"))}'
            f'<pre>{html.escape(study.out.units.sentence(made.to.lines(study.check)))}</pre>'
            f'<pre id="problems" data-count="0"></pre><script type="text/plain" id="plotly">{packed}</script>'
            + made.data("figures", made.to.all([figure for _, _, figure in study.figures])) + made.data("words", words)
            + f"<script>{SCRIPT}</script></body></html>")
