"""The sentences of the live page. Its scripts and its template name them in English; the page gets them in its
language."""
from __future__ import annotations

import html
import re

from .language import Language, phrase

#: Of bindings/web/live/page.html, in [[ ]]. The script replaces each field by a value.
PAGE = (
    phrase("the string in its hole"), phrase("the string in its hole: arrow keys turn, + and - zoom"), phrase("rig"),
    phrase("bit"),
    phrase("contact with the wall, 0 to"), phrase("look at"), phrase("Whole"), phrase("Rig"), phrase("Bit"),
    phrase("To scale"),
    phrase("Across the hole"), phrase("run"), phrase("Run"), phrase("Step"), phrase("Reset"), phrase("Speed"),
    phrase("real time"), phrase("fastest"),
    phrase("traces"), phrase("controls"), phrase("Keep state"), phrase("Restore"), phrase("Save log"),
    phrase("About this page"),
    phrase("Keys: space runs and stops, S steps, R resets, K keeps, L restores; arrows turn the view, + and - zoom."),
    phrase("Saved logs hold each value that was set, with its time, and the hash of the state. This command computes "
           "the same run and compares the hash:"),
)
#: Of the scripts beside it, by word().
SCRIPTS = (
    phrase("This browser has no WebAssembly, which computes the string. Every browser since 2018 has it: update this "
           "one, or open the page in another."),
    phrase("The computation stopped: {reason}. Reload the page.", reason="{reason}"),
    phrase("computing the static equilibrium ..."),
    phrase("starting ..."), phrase("This browser has no WebGL: the string is drawn as lines."), phrase("Restore"),
    phrase("Restore {time} s", time="{time}"), phrase("{pace} times real time", pace="{pace}"),
    phrase("hash {hash}", hash="{hash}"),
    phrase("{message}", message="{message}"), phrase("The scene could not start: {reason}", reason="{reason}"),
    phrase("Failed at {time} s: {reason}", time="{time}", reason="{reason}"), phrase("to scale"),
    phrase("{factor} times", factor="{factor}"),
    phrase("{length} m shown, to scale", length="{length}"),
    phrase("{length} m shown, across the hole {factor} times as large", length="{length}", factor="{factor}"),
    phrase("Stop"), phrase("Run"),
    phrase("Hole diameter"), phrase("restarts the run"), phrase("building the model again ..."),
    phrase("now {value}", value="{value}"),
    phrase("as in the scene"), phrase("OVER {limit}", limit="{limit}"),
    phrase("{share} % of {limit}", share="{share}", limit="{limit}"),
    phrase("Press Reset."), phrase("The last accepted state is kept: change an input, restore, or reset."),
    phrase("The scene before it continues."),
    phrase("This scene cannot run in this browser."),
)


def of_scripts(to: Language) -> dict[str, str]:
    """Translations by the English sentence; none for English."""
    return {} if to.name == "en" else {str(one): to(one) for one in SCRIPTS}


def filled(template: str, to: Language) -> str:
    """The template with its sentences in [[ ]] in the language of the page."""
    known = {str(one): one for one in PAGE}
    return re.sub(r"\[\[(.+?)\]\]", lambda match: html.escape(to(known[match[1]])), template)
