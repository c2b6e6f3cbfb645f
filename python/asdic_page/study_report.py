"""A study, or a comparison of studies, as one page: the question, the answers with their intervals, what was drawn,
which input matters, how the false alarms came out, and all that is needed to make it again. No script, nothing from a
network; a browser prints it as PDF.
"""
from __future__ import annotations

import base64
import html
import io
import json
import tomllib
from pathlib import Path

import h5py
import numpy as np

from asdic_pictures import output, study_comparison, study_data, study_pictures, style
from asdic_pictures.study_data import _text, _words, spoken

from .page import MARK, is_ours, save

KINDS = (study_data.KIND, study_comparison.KIND)
POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
MOST_ROWS = 60  # of a table that is shown
CSS = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #1d1d1f;
  background: #fff; }
h1 { font-size: 1.6rem; margin-bottom: 0.2rem; } h2 { margin-top: 2.2rem; border-bottom: 1px solid #ccc; }
.note { color: #555; } .warning { border-left: 4px solid #d55e00; padding-left: 0.7rem; }
.answer { font-size: 1.25rem; border-left: 4px solid #0072b2; padding: 0.3rem 0.9rem; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: 0.15rem 0.7rem; text-align: right; border-bottom: 1px solid #e3e3e3; white-space: nowrap; }
th:first-child, td:first-child, .text td, .text th { text-align: left; } td.law { white-space: normal; }
img { max-width: 100%; } figure { margin: 1rem 0; } figcaption { color: #555; }
pre { overflow-x: auto; background: #f5f5f7; padding: 0.8rem; font-size: 0.8rem; }
@media print { details { display: none; } h2 { break-after: avoid; } figure { break-inside: avoid; } }
"""
PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
{mark}{version}">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>{title} · asdic</title>
<style>{css}</style>
</head>
<body>
{body}
</body>
</html>
"""
escape = html.escape


def number(value: float) -> str:
    digits = 6 if abs(value) >= 1000.0 else 4  # 22000, not 2.2e+04
    return "–" if not np.isfinite(value) else f"{value:.{digits}g}".replace("-", "−")


def table(head: list, rows: list, text: bool = False) -> str:
    shown = rows[:MOST_ROWS]
    lines = "".join("<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in shown)
    more = f'<p class="note">… and {len(rows) - len(shown)} rows more, in the file.</p>' if len(rows) > len(shown) else ""
    names = "".join(f"<th>{escape(name)}</th>" for name in head)
    style_of = ' class="text"' if text else ""
    return f'<div class="scroll"><table{style_of}><thead><tr>{names}</tr></thead><tbody>{lines}</tbody></table></div>{more}'


def cells_of(column) -> list:
    """A column of a summary as words."""
    if column.labels:
        return [column.labels[int(v)] if np.isfinite(v) and 0 <= v < len(column.labels) else "–"
                for v in column.values]
    return [number(v) for v in column.values]


def summary_table(of) -> str:
    """Each number with its interval in one cell."""
    names = [c.name for c in of.columns]
    intervals = {n for n in names if f"{n}_low" in names and f"{n}_high" in names}
    hidden = {f"{n}{end}" for n in intervals for end in ("_low", "_high")}
    columns = [c for c in of.columns if c.name not in hidden]
    cells = []
    for column in columns:
        told = cells_of(column)
        if column.name in intervals:
            low, high = (of[column.name + end].values for end in ("_low", "_high"))
            told = [f"{v} ({number(a)} to {number(b)})" for v, a, b in zip(told, low, high)]
        cells.append(told)
    head = [c.name + (f" [{c.unit}]" if c.unit not in ("", "1") else "") for c in columns]
    return f"<h3>{escape(of.title)}</h3>" + table(head, list(zip(*cells)))


def figures(drawn) -> str:
    """Pictures that stand in the page."""
    made = []
    for name, figure in drawn:
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=110)
        figure.clear()
        data = base64.b64encode(buffer.getvalue()).decode()
        made.append(f'<figure><img alt="{escape(name)}" src="data:image/png;base64,{data}">'
                    f"<figcaption>{escape(name)}</figcaption></figure>")
    return "".join(made)


def law_of(vary: dict, column) -> str:
    """The law of an input, as the study file has it."""
    for key, law in vary.items():
        if not isinstance(law, dict):
            continue
        last = key.rsplit(".", 1)[-1]
        if column.name in (law.get("name"), key, key.replace(".", "_"), last) or column.name.startswith(f"{last}_"):
            words = ", ".join(f"{k} {law[k]}" for k in law if k not in ("law", "name", "unit", "rows", "casts", "keys"))
            many = next((f", {len(law[k])} of them" for k in ("casts", "rows") if k in law), "")
            return f"{law.get('law', '')}{': ' if words else ''}{words}{many}"[:300]
    return ""


def inputs(study, vary: dict) -> str:
    rows = []
    for c in (c for c in study.columns if c.role == "input"):
        good = c.values[np.isfinite(c.values)]
        if c.labels:
            count = np.bincount(good.astype(int), minlength=len(c.labels))
            drawn = ", ".join(f"{label} {n}" for label, n in zip(c.labels, count))
            drawn = drawn if len(drawn) < 80 else f"{len(c.labels)} values"
        else:
            drawn = f"{number(good.min())} to {number(good.max())}, mean {number(good.mean())}" if good.size else "–"
        rows.append([c.name, c.unit if c.unit != "1" else "", law_of(vary, c), drawn, c.meaning])
    as_drawn = "drawn" if study.weights is None else "drawn, from a proposal: not weighed"
    return table(["input", "unit", "law", as_drawn, "what it is"], rows, True)


def answer(study) -> str:
    """The first question's, as the study's own tables have it."""
    statistics = next((t for t in study.summary if t.name == "convergence"), None)
    if statistics is None:
        return ""
    name = next((c.name for c in statistics.columns if f"{c.name}_low" in statistics), None)
    if name is None:
        return ""
    value, low, high = (statistics[name + end].values[-1] for end in ("", "_low", "_high"))
    unit = f" {statistics[name].unit}" if statistics[name].unit != "1" else ""
    return (f'<p class="answer">{escape(spoken(name))}: <b>{number(value)}{escape(unit)}</b>, {number(low)} to '
            f"{number(high)} with {escape(study.interval)}, after {int(statistics['count'].values[-1])} realisations</p>")


def false_alarms(study) -> str:
    """What came out of what was asked for."""
    if study.false_alarms is None:
        return ""
    rows = []
    for c in (c for c in study.columns if c.name.startswith("false_alarm") and not c.name.endswith("_of_noise")):
        good = c.values[np.isfinite(c.values)]
        if good.size:
            known = np.isfinite(c.values)
            rate = good.mean() if study.weights is None else np.average(good, weights=study.weights[known])
            rows.append([c.name, number(study.false_alarms), int(good.size), int(good.sum()), number(rate)])
    tables = "".join(summary_table(t) for t in study.summary if t.name.startswith(("false_alarm", "tail", "pfa")))
    return (f"<h2>False alarms</h2>{table(['measure', 'asked for', 'looks', 'false alarms', 'rate'], rows)}{tables}"
            if rows or tables else "")


def how_made(f) -> str:
    rows = []
    for line in _words(f["run/sessions"]).splitlines() if "run/sessions" in f else []:
        told = json.loads(line)
        made = told.get("made", told)
        rows.append([made.get(key, "") for key in ("started", "host", "cpu", "threads", "program_version", "build")]
                    + [told.get("rows", ""), number(float(told.get("seconds", np.nan)))])
    if not rows:
        return ""
    return "<h2>How it was made</h2>" + table(["started", "host", "processor", "threads", "asdic", "build", "rows",
                                               "seconds"], rows, True)


def digests(f) -> str:
    told = json.loads(_words(f["manifest"])).get("datasets", {}) if "manifest" in f else {}
    rows = [[name, one.get("sha256", "")] for name, one in told.items()]
    return f"<details><summary>SHA-256 of {len(rows)} datasets</summary>{table(['dataset', 'SHA-256'], rows, True)}</details>"


def verbatim(what: str, words: str) -> str:
    return f"<details><summary>{escape(what)}, verbatim</summary><pre>{escape(words)}</pre></details>"


def attributes(f, names) -> str:
    rows = []
    for name in names:
        if name in f.attrs:
            value = f.attrs[name]
            rows.append([name, ", ".join(_text(v) for v in np.ravel(value))])
    return table(["", ""], rows, True)


def warnings(holder) -> str:
    told = [_text(w) for w in np.ravel(holder.attrs["warnings"])] if "warnings" in holder.attrs else []
    return "".join(f'<p class="warning">{escape(w)}</p>' for w in told)


def of_weights(study, summary) -> str:
    """Of rows that are drawn from a proposal: what their weights do not carry, and what is left out."""
    if study.weights is None:
        return ""
    left_out = f'<p class="note">{escape(study.left_out)}</p>' if study.left_out else ""
    return warnings(summary) + left_out


def of_study(path) -> tuple:
    """→ title, body"""
    study = study_data.read(path)
    with h5py.File(path, "r") as f:
        try:
            vary = tomllib.loads(_words(f["study"])).get("vary", {})
        except tomllib.TOMLDecodeError:
            vary = {}
        with style.look("light"):
            pictures = figures(study_pictures.draw(study))
        by = [t for t in study.summary if t.name in ("statistics", "roc_area", "drawn_from")
              or "_by_" in t.name or t.name.startswith(("pings", "first_detection", "map_"))]
        influence = [t for t in study.summary if t.name in ("sensitivity", "interactions")]
        body = [f"<h1>{escape(study.title or Path(path).name)}</h1><p class=\"note\">{escape(study.heading())}</p>",
                answer(study), warnings(f), of_weights(study, f["summary"]), "<h2>What was drawn</h2>", inputs(study, vary), false_alarms(study),
                "<h2>Pictures</h2>", pictures, "<h2>Answers</h2>", *map(summary_table, by)]
        if influence:
            body += ["<h2>Which input matters</h2>", *map(summary_table, influence)]
        body += [how_made(f), "<h2>To make it again</h2>",
                 attributes(f, ("identity", "seed", "design", "realisations", "stopped_by", "overrides",
                                "program_version", "build")),
                 verbatim("The study file", _words(f["study"])), verbatim("The scenario", _words(f["scenario"])),
                 digests(f)]
    return study.title or Path(path).name, "\n".join(body)


def of_comparison(path) -> tuple:
    """→ title, body"""
    comparison = study_comparison.read(path)
    title = " against ".join(spoken(n) for n in comparison.names)
    with h5py.File(path, "r") as f:
        with style.look("light"):
            pictures = figures(study_comparison.draw(comparison))
        order = sorted(comparison.summary, key=lambda t: (t.name != "differences", not t.name.startswith(("pd_", "p_"))))
        unlike = [_text(n) for n in np.ravel(f.attrs.get("unlike_inputs", []))]
        body = [f"<h1>{escape(title)}</h1><p class=\"note\">{escape(comparison.heading())}</p>",
                f"<pre>{escape(_words(f['answers']))}</pre>"]
        if unlike:
            body.append(f'<p class="warning">Not the same in the rows of all studies: {escape(", ".join(unlike))}</p>')
        body.append("".join(dict.fromkeys(warnings(f["studies"][name]) for name in comparison.names)))
        body += ["<h2>Pictures</h2>", pictures, "<h2>Differences</h2>",
                 '<p class="note">Each bin\'s interval holds by itself: of 20 at 95 %, one is expected to miss.</p>',
                 *map(summary_table, order), "<h2>To make it again</h2>",
                 attributes(f, ("names", "titles", "identities", "files", "seed", "design", "realisations",
                                "program_version", "build"))]
        for name in comparison.names:
            body += [verbatim(f"The study file of {name}", _words(f[f"studies/{name}/study"])),
                     verbatim(f"The scenario of {name}", _words(f[f"studies/{name}/scenario"]))]
        body.append(digests(f))
    return title, "\n".join(body)


def write(file, path, kind: str, force: bool = False) -> Path:
    """Writes the page, whole or not at all, never over what asdic did not write. \\throws InputError, OSError"""
    path = Path(path)
    output.check(path, force or is_ours(path))
    title, body = (of_study if kind == study_data.KIND else of_comparison)(file)
    with h5py.File(file, "r") as f:
        version = _text(f.attrs.get("program_version", ""))
    made = PAGE.format(mark=MARK, version=" " + escape(version), policy=POLICY, title=escape(title), css=CSS, body=body)
    save(made, path)
    return path
