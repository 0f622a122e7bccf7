// Controls: what is shown, and how buttons, keys, mouse and fingers change it.

const $ = id => document.getElementById(id), canvas = $("picture"), ctx = canvas.getContext("2d", { alpha: false }), camera = new Camera();
const PACES = [1, 2, 5, 10, 20, 30, 60];  // frames in a second
const TAP = 8;  // pixels that a finger may slip
const shown = { frame: 0, field: null, chains: false, grain: null, middle: false, playing: false, pace: 20, drawn: 0, drawing_ms: 0 };
let run = null, dirty = false, pixel = 1, since = null;

function changed() {
  if (dirty) return;
  dirty = true;
  requestAnimationFrame(draw);
}

function draw(now) {
  dirty = false;
  if (shown.playing) advance(now);
  if (shown.middle && shown.grain !== null && run.frames[shown.frame].there[shown.grain]) {
    camera.x = run.x(run.frames[shown.frame], shown.grain);
    camera.z = run.z(run.frames[shown.frame], shown.grain);
  }
  const from = performance.now();
  drawFrame(ctx, camera, run, shown, pixel);
  shown.drawing_ms = performance.now() - from;
  shown.drawn++;
  tellTime();
  if (shown.chains) $("mean-force").style.height = `${Math.min(MEAN_WIDTH * camera.scale / pixel, 20)}px`;
  if (shown.grain !== null) tellGrain();
  if (shown.playing) changed();
}

// So many frames as the pace asks for, none twice; after the last the first.
function advance(now) {
  if (since === null) since = now;
  const steps = Math.floor((now - since) * shown.pace / 1000);
  if (!steps) return;
  since += steps * 1000 / shown.pace;
  shown.frame = (shown.frame + steps) % run.frames.length;
}

function play(on) {
  shown.playing = on && run.frames.length > 1;
  since = null;
  $("play-shape").setAttribute("d", shown.playing ? "M4 3h4v14H4zM12 3h4v14h-4z" : "M5 3l12 7-12 7z");
  changed();
}

function goTo(frame) {
  play(false);
  shown.frame = Math.max(0, Math.min(run.frames.length - 1, frame));
  changed();
}

function tellTime() {
  const { number, time_s, overlaps } = run.content, f = shown.frame, deep = overlaps[f].map(([depth]) => depth);
  const told = deep.length ? `, deep overlaps: ${deep.length}, up to ${shortNumber(Math.max(...deep))} d` : "";
  $("scrub").value = f;
  $("clock").innerHTML = `t = ${time_s[f].toFixed(timeDigits())} s <small>frame ${f + 1} of ${number.length}, snapshot ${number[f]}${told}</small>`;
}

function timeDigits() {
  const times = run.content.time_s, step = times.length > 1 ? (times[times.length - 1] - times[0]) / (times.length - 1) : 0.01;
  return Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(Math.max(step, 1e-6)))));
}

// Pace in frames a second, and how many times as fast as it was that is.
function fillPaces() {
  const times = run.content.time_s, n = times.length, step = n > 1 ? (times[n - 1] - times[0]) / (n - 1) : 0;
  for (const pace of PACES) {
    const real = step * pace;
    $("pace").append(new Option(`${pace}/s${real > 0 ? `, ${shortNumber(+real.toPrecision(real < 0.1 || real > 10 ? 1 : 2))} ×` : ""}`, pace));
  }
  // As fast as it was, where the eye can follow that.
  shown.pace = PACES.filter(pace => pace >= 5 && pace <= 30).reduce((best, pace) =>
    Math.abs(Math.log(pace * step || 1)) < Math.abs(Math.log(best * step || 1)) ? pace : best, 20);
  $("pace").value = shown.pace;
}

function choose(name) {
  shown.field = run.content.fields.find(field => field.name === name) || run.content.fields[0];
  $("field").value = shown.field.name;
  tellLegend();
  changed();
}

function chooseNext(by) {
  const fields = run.content.fields, k = fields.indexOf(shown.field);
  choose(fields[(k + by + fields.length) % fields.length].name);
}

function element(name, parts = [], attributes = {}) {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...[].concat(parts));
  return made;
}

function ticksOf(field) {
  const { low, high } = field;
  if (field.scale === "log") {
    const found = [];
    for (let k = Math.ceil(Math.log10(low) - 1e-9); 10 ** k <= high * (1 + 1e-9); k++) found.push(10 ** k);
    return found.map(v => [v, Math.log(v / low) / Math.log(high / low)]);
  }
  const rough = (high - low) / 4, power = 10 ** Math.floor(Math.log10(rough)), step = [1, 2, 5, 10].map(k => k * power).find(s => s >= rough);
  const found = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) found.push(Math.abs(v) < 1e-9 * step ? 0 : v);
  return found.map(v => [v, (v - low) / (high - low)]);
}

function tellLegend() {
  const field = shown.field, parts = [element("div", field.words + (field.unit ? ` [${field.unit}]` : ""))];
  const swatch = colour => { const i = element("i"); i.style.background = shown.chains ? lighter(colour) : colour; return i; };
  if (field.names || field.scale === "steps") {
    const names = field.names || field.colours.map((_, k) => String(k));
    parts.push(element("div", names.map((name, k) => element("span", [swatch(field.colours[k]), name])), { className: "names" }));
  } else {
    parts.push(element("div", field.colours.map(swatch), { className: "bar" }));
    parts.push(element("div", ticksOf(field).map(([value, at]) => {
      const tick = element("span", shortNumber(value));
      tick.style.left = `${100 * at}%`;
      if (at < 0.04 || at > 0.96) tick.style.transform = at < 0.5 ? "none" : "translateX(-100%)";
      return tick;
    }), { className: "ticks" }));
  }
  if (shown.chains) {
    const line = element("b", [], { id: "mean-force" });
    line.style.background = GRAIN_CONTACT;
    parts.push(element("div", [line, `mean normal force ${shortNumber(run.content.mean_force)} ρ₀gd²`], { className: "key" }));
  }
  $("legend").replaceChildren(...parts);
}

function follow(grain) {
  shown.grain = grain;
  if (grain === null) shown.middle = false;
  $("grain").hidden = grain === null;
  changed();
}

function grainAt(x, y) {
  const frame = run.frames[shown.frame], atX = camera.ofX(x), atZ = camera.ofY(y);
  let best = null, nearest = Infinity;
  for (let g = 0; g < run.content.count; g++) {
    if (!frame.there[g]) continue;
    const beyond = Math.hypot(run.x(frame, g) - atX, run.z(frame, g) - atZ) - run.radius[g];
    if (beyond < nearest) { nearest = beyond; best = g; }
  }
  return nearest * camera.scale <= 6 * pixel ? best : null;
}

// The numbers of the grain that is followed, and the chosen field of it over the time.
function tellGrain() {
  const box = $("grain"), g = shown.grain, f = shown.frame, frame = run.frames[f], content = run.content;
  if (!box.firstChild || box.dataset.grain !== String(g)) {
    const middle = element("button", "Keep in the middle", { id: "middle", onclick: () => keepInMiddle(!shown.middle) });
    const close = element("button", "Let go", { id: "let-go", onclick: () => follow(null) });
    box.replaceChildren(element("h2", `Grain ${run.id[g]}`), element("div", [middle, close], { className: "row" }),
      element("table", element("tbody")), element("canvas"));
    box.dataset.grain = g;
  }
  $("middle").setAttribute("aria-pressed", shown.middle);
  const place = (name, value) => [name, `${value.toFixed(2)} d`, `${(1e3 * value * content.scales.length_m).toFixed(1)} mm`].map(text => text.replace("-", "−"));
  const rows = frame.there[g] ? [place("x", run.x(frame, g)), place("z", run.z(frame, g))] : [["not there", "", ""]];
  for (const field of frame.there[g] ? content.fields : []) {
    if (field.name === "id") continue;
    const value = run.values(field.name, f)[g], least = field.name === "speed" && frame.speed[g] === 0 ? "≤ " : "";
    const text = field.names ? field.names[value] : least + shortNumber(value);
    rows.push([field.name, `${text} ${field.unit}`, field.si_unit ? `${shortNumber(value * field.si)} ${field.si_unit}` : ""]);
  }
  box.querySelector("tbody").replaceChildren(...rows.map(row => element("tr", row.map(cell => element("td", cell)))));
  drawCurve(box.querySelector("canvas"), g);
}

function keepInMiddle(on) { shown.middle = on && shown.grain !== null; changed(); }

function drawCurve(picture, g) {
  const box = picture.getBoundingClientRect(), ratio = devicePixelRatio || 1, field = shown.field;
  picture.hidden = field.source === "id" || field.source === "radius" || field.source === "material";
  if (!box.width || picture.hidden) return;
  const width = picture.width = box.width * ratio, height = picture.height = box.height * ratio, pen = picture.getContext("2d");
  const values = run.frames.map((frame, f) => frame.there[g] ? run.values(field.name, f)[g] : NaN), known = values.filter(v => v === v);
  const log = field.scale === "log", of = v => log ? Math.log(Math.max(v, field.low / 10)) : v;
  const low = Math.min(...known.map(of)), high = Math.max(...known.map(of)), top = 16 * ratio, bottom = height - 3 * ratio;
  const toX = f => (f + 0.5) * width / values.length, toY = v => bottom - (of(v) - low) / (high - low || 1) * (bottom - top);
  pen.strokeStyle = "#d5d9de";
  pen.beginPath(); pen.moveTo(toX(shown.frame), top); pen.lineTo(toX(shown.frame), bottom); pen.stroke();
  pen.strokeStyle = "#0072b2"; pen.lineWidth = 1.3 * ratio;
  pen.beginPath();
  values.forEach((v, f) => { if (v === v) pen[f && values[f - 1] === values[f - 1] ? "lineTo" : "moveTo"](toX(f), toY(v)); });
  pen.stroke();
  if (run.frames[shown.frame].there[g]) { pen.fillStyle = "#b00000"; pen.beginPath(); pen.arc(toX(shown.frame), toY(values[shown.frame]), 3 * ratio, 0, 7); pen.fill(); }
  pen.fillStyle = "#5a6068"; pen.font = `${11 * ratio}px system-ui, sans-serif`;
  pen.fillText(`${field.name} over time${log ? ", log" : ""}: ${shortNumber(Math.min(...known))} to ${shortNumber(Math.max(...known))}`, 0, 11 * ratio);
}

function showAll() {
  shown.middle = false;
  // On a phone held upright the legend stands above the picture, and below it is room for the numbers of a grain.
  const upright = canvas.clientWidth < 640 && canvas.clientHeight > canvas.clientWidth;
  camera.show(run.content.view, 12 * pixel, upright ? ($("legend").offsetTop + $("legend").offsetHeight) * pixel : 0);
  changed();
}

function toggleChains() {
  shown.chains = !shown.chains;
  $("chains").setAttribute("aria-pressed", shown.chains);
  tellLegend();
  changed();
}

// The canvas has as many pixels as the screen, on phones at most two for each of the page's.
function fitCanvas() {
  const box = canvas.getBoundingClientRect(), before = pixel;
  pixel = Math.min(devicePixelRatio || 1, 2);
  camera.width = canvas.width = Math.max(1, Math.round(box.width * pixel));
  camera.height = canvas.height = Math.max(1, Math.round(box.height * pixel));
  camera.scale *= pixel / before;
}

const fingers = new Map();
let slipped = 0;

function place(event) {
  const box = canvas.getBoundingClientRect();
  return [(event.clientX - box.x) * pixel, (event.clientY - box.y) * pixel];
}

function moved(event) {
  if (!fingers.has(event.pointerId)) return;
  const from = fingers.get(event.pointerId), to = place(event), others = [...fingers].filter(([id]) => id !== event.pointerId);
  slipped += Math.hypot(to[0] - from[0], to[1] - from[1]);
  fingers.set(event.pointerId, to);
  if (slipped < TAP * pixel) return;
  if (others.length === 0) {
    camera.x -= (to[0] - from[0]) / camera.scale;
    camera.z += (to[1] - from[1]) / camera.scale;
    shown.middle = false;
  } else {
    const [x, y] = others[0][1], before = Math.hypot(from[0] - x, from[1] - y), now = Math.hypot(to[0] - x, to[1] - y);
    if (before > 0) camera.zoom(now / before, (to[0] + x) / 2, (to[1] + y) / 2);
    camera.x -= (to[0] - from[0]) / 2 / camera.scale;
    camera.z += (to[1] - from[1]) / 2 / camera.scale;
  }
  changed();
}

function released(event) {
  if (fingers.delete(event.pointerId) && event.type === "pointerup" && slipped < TAP * pixel && fingers.size === 0) follow(grainAt(...place(event)));
}

const KEYS = {
  " ": () => play(!shown.playing), ArrowRight: event => goTo(shown.frame + (event.shiftKey ? 10 : 1)), ArrowLeft: event => goTo(shown.frame - (event.shiftKey ? 10 : 1)),
  Home: () => goTo(0), End: () => goTo(run.frames.length - 1), "+": () => zoomBy(1.25), "=": () => zoomBy(1.25), "-": () => zoomBy(0.8), "0": showAll,
  c: () => chooseNext(1), C: () => chooseNext(-1), f: toggleChains, k: () => keepInMiddle(!shown.middle), "?": () => help($("help").hidden),
  Escape: () => { if ($("help").hidden) follow(null); else help(false); } };

function zoomBy(factor) { camera.zoom(factor, camera.width / 2, camera.height / 2); changed(); }
function help(on) { $("help").hidden = !on; }

function listen() {
  canvas.addEventListener("pointerdown", event => {
    if (fingers.size === 0) slipped = 0;
    fingers.set(event.pointerId, place(event));
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", moved);
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, released);
  canvas.addEventListener("wheel", event => { event.preventDefault(); camera.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)), ...place(event)); changed(); }, { passive: false });
  addEventListener("keydown", event => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT" || !(event.key in KEYS)) return;
    if (event.key === " " && event.target.tagName === "BUTTON") event.target.blur();
    event.preventDefault();
    KEYS[event.key](event);
  });
  const on = (id, act) => $(id).addEventListener("click", act);
  on("play", () => play(!shown.playing)); on("back", () => goTo(shown.frame - 1)); on("forward", () => goTo(shown.frame + 1));
  on("chains", toggleChains); on("fit", showAll); on("open-help", () => help($("help").hidden)); on("close-help", () => help(false));
  $("scrub").addEventListener("input", () => goTo(+$("scrub").value));
  $("field").addEventListener("change", () => choose($("field").value));
  $("pace").addEventListener("change", () => { shown.pace = +$("pace").value; since = null; });
  new ResizeObserver(() => { fitCanvas(); changed(); }).observe(canvas);
}

async function start() {
  const content = JSON.parse($("content").textContent);
  run = await Run.of(content, $("data").textContent);
  $("data").remove();
  fitCanvas();
  fillPaces();
  choose(content.field);
  $("made").textContent = `Drumlin, revision ${content.revision}. Places are held to ${shortNumber(content.quantum / 2)} d, speeds to ${shortNumber(100 * content.speed.step / 2)} % (slower than ` +
    `${shortNumber(content.speed.low)} √(gd): shown as that), forces to ${shortNumber(100 / content.force_steps)} % of the mean force where they are of that size. Nothing is drawn between snapshots.`;
  listen();
  showAll();
  $("message").hidden = true;
}

start().catch(error => { $("message").textContent = `This page cannot be shown: ${error.message}`; throw error; });
