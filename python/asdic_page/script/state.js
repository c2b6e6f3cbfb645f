// The page of a ping file: panels on canvases. A panel knows its axes, draws its data once and what is
// chosen (a time, a target, a ping) on a canvas above. Nothing is fetched: data stand in the page.
"use strict";

const D = JSON.parse(document.getElementById("data").textContent);
const S = {view: 0, time: null, pinned: false, target: null};
const T = {lo: 0, hi: 1, full: [0, 1]}; // the time axis that panels share
const panels = [];
const $ = (id) => document.getElementById(id);
const view = () => D.views[S.view];
