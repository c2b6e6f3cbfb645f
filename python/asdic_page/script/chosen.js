// A time, a target, a ping that is chosen, in all panels.
function tip(lines, x, y) {
  const box = $("tip");
  if (!lines) {
    box.hidden = true;
    return;
  }
  box.hidden = false;
  box.replaceChildren(
    ...lines.map((l) => Object.assign(document.createElement("div"), {textContent: l}))
  );
  if (x === undefined) return;
  const w = box.offsetWidth,
    h = box.offsetHeight;
  box.style.left = Math.max(4, x + 16 + w > innerWidth ? x - w - 12 : x + 16) + "px";
  box.style.top = Math.max(4, y + 16 + h > innerHeight ? y - h - 12 : y + 16) + "px";
}
function letGoOfTime() {
  if (!S.pinned && S.time !== null) {
    S.time = null;
    drawOvers();
  }
}
function drawAll() {
  for (const p of panels) p.draw();
}
function drawOvers() {
  for (const p of panels) p.drawOver();
}

function chooseTarget(target) {
  S.target = target;
  for (const b of document.querySelectorAll("#targets button"))
    b.setAttribute("aria-pressed", String(Number(b.dataset.target) === target));
  let first = null;
  document.querySelectorAll("#scenario span").forEach((line, i) => {
    const mine =
      target !== null && D.tables[target] && i >= D.tables[target][0] && i < D.tables[target][1];
    line.classList.toggle("chosen", Boolean(mine));
    if (mine && !first) first = line;
  });
  if (first) {
    const box = $("scenario");
    box.scrollTop = first.offsetTop - 20;
  }
  for (const row of document.querySelectorAll("#found tbody tr"))
    row.classList.toggle("chosen", target !== null && Number(row.dataset.target) === target);
  drawOvers();
}
function choosePing(number, array = view().array) {
  const off = D.views.map((v) => (v.array === array ? Math.abs(v.ping - number) : Infinity));
  const k = off.indexOf(Math.min(...off)); // the nearest that is here
  if (k !== S.view) show(k);
}
