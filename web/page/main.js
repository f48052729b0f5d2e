// The page: playback, numbers, and what the core computes.

const data = JSON.parse(document.getElementById("data").textContent);
const find = (id) => document.getElementById(id);
const show = (...ids) => ids.forEach((id) => { find(id).hidden = false; });
const champions = data.champions.map(unpacked);

// What is on the stage, and how it plays.
const state = { lanes: [], chosen: 0, time: 0, speed: 1, plays: false, theme: "light", orbit: { yaw: -0.55, pitch: 0.36, distance: 18, target: [0, 0, 0] }, isDirty: true, twin: null, offspring: null };
let scene = null;

function duration() { return Math.max(...state.lanes.map((lane) => lane.champion.duration)); }

// Places the champions side by side, those of the page first.
function setLanes(list) {
  const width = Math.max(...list.map(({ champion }) => champion.width_m)) + 1.5;
  state.lanes = list.map((lane, index) => ({ ...lane, shift: (index - (list.length - 1) / 2) * width, poses: posesAt(lane.champion, state.time) }));
  const labels = find("labels");
  labels.replaceChildren(...state.lanes.map((lane) => { const label = document.createElement("span"); label.textContent = lane.champion.name; label.hidden = state.lanes.length < 2; return label; }));
  find("time").max = duration();
  state.isDirty = true;
}

function stagedLanes() {
  const base = data.is_run ? [{ champion: champions[state.chosen] }] : champions.map((champion) => ({ champion }));
  return [...base, ...[state.twin, state.offspring].filter(Boolean).map((champion) => ({ champion, pale: champion === state.twin }))];
}

function subject() { return champions[state.chosen]; }

function numbersTable() {
  const table = document.createElement("table"), head = table.insertRow();
  for (const title of ["", "Way", "Steps", "Energy"]) { const cell = document.createElement("th"); cell.textContent = title; head.append(cell); }
  state.lanes.forEach(({ champion }) => {
    const row = table.insertRow(), name = row.insertCell();
    const place = champions.indexOf(champion);
    if (place < 0 || champions.length === 1 || data.is_run) { name.append(champion.name); } else {
      const button = document.createElement("button");
      button.className = "quiet"; button.textContent = champion.name; button.title = "Show its torques, and use it below";
      button.setAttribute("aria-pressed", place === state.chosen); button.onclick = () => choose(place);
      name.append(button);
    }
    for (let i = 0; i < 3; i++) row.insertCell();
  });
  find("numbers").replaceChildren(table);
}

function updateNumbers() {
  const rows = find("numbers").querySelectorAll("tr");
  state.lanes.forEach(({ champion, poses }, index) => {
    const cells = rows[index + 1].cells, middle = poses[Math.floor(poses.length / 2)].at[1];
    cells[1].textContent = `${middle.toFixed(2)} m`;
    cells[2].textContent = `${atTime(champion, champion.steps, state.time)} of ${champion.step_count}`;
    cells[3].textContent = `${(atTime(champion, champion.energy, state.time) / 1000).toFixed(2)} kJ`;
  });
  find("clock").textContent = `${state.time.toFixed(1)} s`;
  const time = find("time");
  time.value = state.time; time.setAttribute("aria-valuetext", `${state.time.toFixed(1)} seconds`);
}

function follow() {
  const middles = state.lanes.map(({ poses, shift }) => { const { at } = poses[Math.floor(poses.length / 2)]; return [at[0] + shift, at[1], at[2]]; });
  const mean = [0, 1, 2].map((axis) => (Math.min(...middles.map((m) => m[axis])) + Math.max(...middles.map((m) => m[axis]))) / 2);
  const spread = Math.max(...middles.map((m) => Math.hypot(m[0] - mean[0], m[1] - mean[1])));
  state.orbit.spread = spread;
  state.orbit.target = [mean[0], mean[1] + (state.lanes.length > 1 ? 1 : 3), mean[2] + 0.5];
}

function drawFrame() {
  state.lanes.forEach((lane) => { lane.poses = posesAt(lane.champion, state.time); });
  follow();
  const orbit = { ...state.orbit, distance: state.orbit.distance + state.orbit.spread * 1.2 };
  const places = scene.draw(state.lanes, orbit, state.theme), labels = find("labels").children;
  places.forEach((place, index) => { if (place) { labels[index].style.left = `${place[0] * 100}%`; labels[index].style.top = `${place[1] * 100}%`; } });
  updateNumbers();
  if (subject().torques.length > 0) drawStrip(find("strip"), subject(), state.time);
}

let before = null;
function tick(now) {
  if (state.plays && before !== null) {
    state.time += Math.min(0.1, (now - before) / 1000) * state.speed;
    // The end rests for a moment, then the climb begins again.
    if (state.time > duration() + 1.2) state.time = 0;
    state.isDirty = true;
  }
  before = now;
  if (state.isDirty) { state.isDirty = false; drawFrame(); document.documentElement.dataset.drawn = "yes"; }
  requestAnimationFrame(tick);
}

function setPlaying(plays) {
  state.plays = plays;
  find("play").textContent = plays ? "Pause" : "Play";
  find("play").setAttribute("aria-pressed", plays);
}

function setTheme(theme) {
  state.theme = theme; document.documentElement.dataset.theme = theme;
  find("theme").textContent = theme === "dark" ? "Light" : "Dark"; state.isDirty = true;
}

function setCamera(name) {
  const [yaw, pitch] = { follow: state.lanes.length > 1 ? [-0.75, 0.5] : [-0.55, 0.36], side: [0, 0.04], top: [0, 1.55] }[name];
  Object.assign(state.orbit, { yaw, pitch, distance: 18 }); state.isDirty = true;
}

function savedAs(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/plain" })); link.download = `${name.replace(/[^\w.-]+/g, "-")}.ron`; link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function listenToMouse() {
  const view = find("view"), fingers = new Map(); let pinch = 0;
  const zoom = (factor) => { state.orbit.distance = Math.max(4, Math.min(120, state.orbit.distance * factor)); state.isDirty = true; };
  const turn = (dx, dy) => { state.orbit.yaw -= dx * 0.006; state.orbit.pitch = Math.max(0.02, Math.min(1.55, state.orbit.pitch + dy * 0.006)); state.isDirty = true; };
  view.addEventListener("pointerdown", (event) => { view.setPointerCapture(event.pointerId); fingers.set(event.pointerId, event); pinch = 0; });
  view.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    fingers.set(event.pointerId, event);
    if (fingers.size === 2) { const [a, b] = fingers.values(), wide = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY); if (pinch > 0) zoom(pinch / wide); pinch = wide; }
    else turn(event.clientX - last.clientX, event.clientY - last.clientY);
  });
  for (const end of ["pointerup", "pointercancel"]) view.addEventListener(end, (event) => { fingers.delete(event.pointerId); pinch = 0; });
  // The wheel alone scrolls the page, as a finger's way up and down does, until the view has been clicked.
  view.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.metaKey && document.activeElement !== view) return;
    event.preventDefault(); zoom(Math.exp(event.deltaY * 0.001));
  }, { passive: false });
  view.addEventListener("dblclick", () => setCamera(find("camera").value));
  view.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [16, 0], ArrowRight: [-16, 0], ArrowUp: [0, 16], ArrowDown: [0, -16] }[event.key];
    if (turns) turn(...turns); else if (event.key === "+") zoom(0.9); else if (event.key === "-") zoom(1.1); else return;
    event.preventDefault();
  });
  document.addEventListener("keydown", (event) => {
    if (["INPUT", "SELECT", "BUTTON", "SUMMARY"].includes(event.target.tagName) || event.ctrlKey || event.metaKey) return;
    if (event.key === " ") { setPlaying(!state.plays); event.preventDefault(); }
  });
}

function listenToPlayer() {
  find("play").onclick = () => setPlaying(!state.plays);
  find("time").oninput = (event) => { setPlaying(false); state.time = Number(event.target.value); state.isDirty = true; };
  find("speed").onchange = (event) => { state.speed = Number(event.target.value); };
  find("camera").onchange = (event) => setCamera(event.target.value);
  find("theme").onclick = () => setTheme(state.theme === "dark" ? "light" : "dark");
  new ResizeObserver(() => { state.isDirty = true; }).observe(find("stage"));
}

function choose(index) {
  state.chosen = index; state.time = 0; state.twin = null; state.offspring = null; find("no-twin").hidden = true;
  restage();
  document.querySelectorAll("#generations button").forEach((button) => button.setAttribute("aria-pressed", Number(button.dataset.champion) === index));
  describe();
  page.chosen?.();
}

function restage() { setLanes(stagedLanes()); numbersTable(); setCamera(find("camera").value); }

function describe() {
  const champion = subject();
  find("strip-note").textContent = `Bend (thick) and twist of ${champion.name}, one row for each joint from the head; full height ${champion.torque_unit_nm.toFixed(0)} N·m.`;
  if (data.is_run) describeFacts(champion);
  offerFiles();
  const slider = find("friction");
  slider.max = Math.max(1.5, 2 * champion.friction); slider.value = champion.friction; state.ownFriction = Number(slider.value);
  find("friction-value").textContent = champion.friction.toFixed(2);
}

// Buttons that save champions: those of a race, or the chosen one of a run.
function offerFiles() {
  find("save-files").replaceChildren(...(data.is_run ? [subject()] : champions).map((champion) => {
    const button = document.createElement("button");
    button.className = "quiet"; button.textContent = `Save ${champion.name}`; button.onclick = () => savedAs(champion.name, champion.file);
    return button;
  }));
}

function describeFacts(champion) {
  const table = document.createElement("table");
  for (const [label, text] of champion.facts) { const row = table.insertRow(), head = document.createElement("th"); head.scope = "row"; head.textContent = label; row.append(head); row.insertCell().textContent = text; }
  const title = document.createElement("h2"); title.textContent = `About ${champion.name}`;
  find("facts").replaceChildren(title, table);
}

const page = {};
function start() {
  try { scene = new Scene(find("view")); } catch (error) { find("problem").textContent = error.message; find("problem").hidden = false; return; }
  find("poster").hidden = true;
  show("view", "player", "numbers", "torques", "theme", "files");
  setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  document.querySelectorAll("#generations button").forEach((button) => { button.onclick = () => choose(Number(button.dataset.champion)); });
  listenToPlayer(); listenToMouse();
  choose(data.is_run ? champions.length - 1 : 0);
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) setPlaying(true);
  requestAnimationFrame(tick);
  setTimeout(compute, 50);
}
