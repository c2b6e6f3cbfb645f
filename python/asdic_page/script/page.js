// The page: what is on it, and where.
let plan = null,
  levels = null,
  past = null;
const images = {};

function show(k) {
  const whole = T.lo === T.full[0] && T.hi === T.full[1];
  S.view = k;
  const v = view();
  T.full = v.time;
  if (whole) [T.lo, T.hi] = T.full;
  else {
    T.hi = Math.min(T.hi, T.full[1]);
    T.lo = Math.min(T.lo, T.hi - 1e-3);
  }
  for (const name of Object.keys(images))
    images[name].take(v.images.find((i) => i.name === name) || null);
  if (levels) levels.take(v.levels);
  if (plan) plan.take(v.map);
  $("ping").value = String(v.ping);
  $("array").value = String(v.array);
  $("about").replaceChildren(
    ...v.about.flatMap(([what, is]) => [
      Object.assign(document.createElement("dt"), {textContent: what}),
      Object.assign(document.createElement("dd"), {textContent: is}),
    ])
  );
  notes();
  foundTable();
  chooseTarget(S.target);
  resizeAll();
}

function notes() {
  const list = [...view().left_out, ...D.notes, ...(D.rays && D.rays.note ? [D.rays.note] : [])];
  $("notes").replaceChildren(
    ...list.map((n) => Object.assign(document.createElement("li"), {textContent: n}))
  );
}

function foundTable() {
  const f = view().detections,
    box = $("found");
  box.hidden = !f;
  if (!f) return;
  const order = f.time
    .map((_, i) => i)
    .sort((a, b) => f.snr[b] - f.snr[a])
    .slice(0, 200);
  box.querySelector("summary").textContent =
    `Detections: ${f.time.length}` + (f.time.length > 200 ? ", the 200 loudest" : "");
  box.querySelector("tbody").replaceChildren(
    ...order.map((i) => {
      const row = document.createElement("tr");
      row.dataset.target = f.target[i];
      for (const words of [
        f.time[i].toFixed(3),
        text(f.snr[i], 3),
        f.bearing_deg[i] === null
          ? "–"
          : bearing(f.bearing_deg[i]) +
            (f.mirror_bearing_deg[i] === null ? "" : " or " + bearing(f.mirror_bearing_deg[i])),
        f.range[i] === null ? "–" : (f.range[i] / 1000).toFixed(3),
        text(f.doppler[i], 3),
        foundBy(f.target[i]),
      ])
        row.append(Object.assign(document.createElement("td"), {textContent: words}));
      row.tabIndex = 0;
      const choose = () => {
        S.time = f.time[i];
        S.pinned = true;
        if (f.target[i] >= 0) chooseTarget(f.target[i]);
        drawOvers();
      };
      row.addEventListener("click", choose);
      row.addEventListener("keydown", (e) => {
        if (e.key === "Enter") choose();
      });
      return row;
    })
  );
}

function resizeAll() {
  for (const p of panels) if (p.shown) p.resize();
  drawAll();
}

function theme(name) {
  if (name) document.documentElement.dataset.theme = name;
  document.querySelectorAll("#targets i").forEach((dot, i) => {
    dot.style.background = targetColour(i);
  });
  if (levels && levels.shown) levels.paintKey();
  drawAll();
}

function start() {
  document.title = D.title + " · asdic";
  $("title").textContent = D.title;
  $("file").textContent = `${D.file} · asdic ${D.version}`;
  const choices = (id, values, label) => {
    $(id).replaceChildren(
      ...values.map(([v, n]) =>
        Object.assign(document.createElement("option"), {value: String(v), textContent: n})
      )
    );
    $(id).parentElement.hidden = values.length < 2;
    $(id).setAttribute("aria-label", label);
  };
  const pings = [...new Set(D.views.map((v) => v.ping))],
    arrays = [...new Set(D.views.map((v) => v.array))];
  choices(
    "ping",
    pings.map((p) => [p, String(p)]),
    "ping"
  );
  choices(
    "array",
    arrays.map((a) => [a, D.arrays[a]]),
    "array"
  );
  $("ping").addEventListener("change", () => choosePing(Number($("ping").value)));
  $("array").addEventListener("change", () => choosePing(view().ping, Number($("array").value)));
  D.targets.forEach((name, i) => {
    const b = Object.assign(document.createElement("button"), {type: "button"});
    b.dataset.target = i;
    b.setAttribute("aria-pressed", "false");
    const dot = document.createElement("i");
    dot.style.background = targetColour(i);
    b.append(dot, name);
    b.addEventListener("click", () => chooseTarget(S.target === i ? null : i));
    $("targets").append(b);
  });
  D.scenario
    .split("\n")
    .forEach((line) =>
      $("scenario").append(
        Object.assign(document.createElement("span"), {textContent: line + "\n"})
      )
    );
  for (const w of D.warnings)
    $("warnings").append(Object.assign(document.createElement("li"), {textContent: w}));
  $("warnings").hidden = !D.warnings.length;

  if (D.rays) new Rays(D.rays);
  const withMap = D.views.find((v) => v.map);
  if (withMap) plan = new Plan(withMap.map);
  if (D.history)
    past = new TimeImage(D.history, {
      wheel: "x",
      height: 150 + 10 * Math.min(20, D.history.cells.rows),
    });
  for (const v of D.views)
    for (const spec of v.images)
      if (!images[spec.name])
        images[spec.name] = new TimeImage(spec, {
          wheel: "x",
          height: spec.name === "Detections" ? 230 : 270,
        });
  const withLevels = D.views.find((v) => v.levels);
  if (withLevels) levels = new Lines(withLevels.levels);
  T.lo = D.views[0].time[0];
  T.hi = D.views[0].time[1];
  T.full = D.views[0].time;
  show(0);

  $("theme").addEventListener("click", () => {
    theme(isDark() ? "light" : "dark");
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => theme());
  addEventListener("resize", resizeAll);
  document.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(e.target.tagName))
      return;
    if (e.key === "Escape") {
      S.pinned = false;
      S.time = null;
      tip(null);
      chooseTarget(null);
    } else if (e.key === "t" && D.targets.length)
      chooseTarget(S.target === null ? 0 : S.target + 1 < D.targets.length ? S.target + 1 : null);
    else if (e.key === "[" || e.key === "]") {
      const k = pings.indexOf(view().ping) + (e.key === "]" ? 1 : -1);
      if (k >= 0 && k < pings.length) choosePing(pings[k]);
    }
  });
}
start();
