// What the page computes itself: the champion again, a twin on other ground, and descendants.

async function compute() {
  show("check");
  const words = find("check-words"), bar = find("check-progress");
  let replayer, module;
  try {
    module = await coreModule();
    replayer = new Core(module);
    const { engine } = await replayer.ready;
    if (engine !== data.engine) throw new Error(`the core in this page is engine ${engine}, the champions are of engine ${data.engine}`);
  } catch (error) {
    bar.hidden = true;
    words.textContent = WebAssembly.validate(SIMD_TEST) ? `The core could not start: ${error.message}. The page plays what was recorded.` : "This browser has no WebAssembly SIMD. The page plays what was recorded, and computes nothing.";
    return;
  }
  show("whatif", "evolve");
  offerTwin(replayer);
  offerEvolution(module, replayer);
  if (data.is_run) page.chosen = () => checkChampions(replayer, words, bar);
  await checkChampions(replayer, words, bar);
}

// A module with one SIMD instruction, after the WebAssembly specification.
const SIMD_TEST = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);

// Simulates champions again and compares their hashes with the records: those of a race, or the chosen one of a run. A check
// that another one has followed says nothing more.
let checks = 0;
async function checkChampions(replayer, words, bar) {
  const check = ++checks, list = data.is_run ? [subject()] : champions, results = [];
  delete find("check").dataset.result;
  bar.hidden = false;
  for (const champion of list) {
    words.textContent = `Simulating ${champion.name} again …`;
    try {
      const { state: found } = await replayer.ask({ champion: champion.file, poses: false }, ({ progress }) => { if (check === checks) bar.value = progress; });
      results.push({ champion, found });
    } catch (error) { results.push({ champion, problem: error.message }); }
    if (check !== checks) return;
  }
  bar.hidden = true;
  const rows = results.map(({ champion, found, problem }) => {
    const row = document.createElement("span"), verdict = document.createElement("span");
    row.append(champions.length > 1 ? `${champion.name}: ` : "", verdict, document.createElement("br"));
    verdict.className = found?.is_equal ? "good" : "bad";
    verdict.textContent = problem ? `could not be simulated: ${problem}` : found.is_equal ? `the same, bit for bit` : `differs from the record (${found.hash} instead of ${champion.hash})`;
    if (found?.is_equal) verdict.after(` (hash ${found.hash})`);
    return row;
  });
  words.replaceChildren(...rows);
  find("check").dataset.result = results.every(({ found }) => found?.is_equal) ? "equal" : "different";
}

// The friction that the slider asks for; none where it stands as it stood when the champion was chosen.
function wantedFriction() {
  const friction = Number(find("friction").value);
  return friction === state.ownFriction ? null : friction;
}

// The name of a snake that was simulated here; where there are several champions, with that of the one it comes from.
function nameOf(champion, difference) { return champions.length > 1 ? `${champion.name}, ${difference}` : difference; }

function offerTwin(replayer) {
  const words = find("twin-words"), button = find("try");
  find("friction").oninput = (event) => { find("friction-value").textContent = Number(event.target.value).toFixed(2); };
  const remove = () => { state.twin = null; find("no-twin").hidden = true; restage(); };
  find("no-twin").onclick = remove;
  button.onclick = async () => {
    const champion = subject(), friction = wantedFriction();
    if (friction === null) { words.textContent = "Choose another friction first: this is its own ground."; return; }
    button.disabled = true;
    try {
      const { state: found, motion } = await replayer.ask({ champion: champion.file, friction, poses: true }, ({ progress }) => { words.textContent = `Simulating … ${(progress * 100).toFixed(0)} %`; });
      // Another one may have been chosen meanwhile.
      if (subject() !== champion) { button.disabled = false; return; }
      state.twin = simulated(champion, nameOf(champion, `friction ${friction.toFixed(2)}`), motion, found);
      state.time = 0; restage(); find("no-twin").hidden = false; setPlaying(true);
      words.textContent = `On friction ${friction.toFixed(2)}: ${found.meaning}${found.disqualified ? ` (disqualified: ${found.disqualified})` : ""}. On its own ground, ${champion.friction.toFixed(2)}: ${champion.meaning}.`;
    } catch (error) { words.textContent = `It could not be simulated: ${error.message}`; }
    button.disabled = false;
  };
}

function offerEvolution(module, replayer) {
  const button = find("evolve-start"), play = find("evolve-play"), save = find("evolve-save"), words = find("evolve-words"), chart = find("evolve-chart");
  // The best descendant's file, with the champion from which it descends.
  let core = null, best = null, seed = 1;
  const keep = (found) => { best = found; play.disabled = save.disabled = !found; };
  const runs = () => button.textContent === "Stop";
  button.onclick = async () => {
    if (runs()) { core.stop(); return; }
    const champion = subject(), friction = wantedFriction();
    button.textContent = "Stop"; keep(null);
    try {
      core ??= new Core(module);
      await core.ready;
      await core.ask({ evolve: true, champion: champion.file, friction, seed: seed++, population: 20 }, ({ evolution, champion: text }) => {
        if (text) keep({ champion, text });
        const { generation, individual, population, history, meaning } = evolution;
        words.textContent = `Generation ${generation}, ${individual} of ${population}${meaning ? `; best: ${meaning}` : ""}`;
        if (history.length > 0 && individual === 0) { chart.hidden = false; drawHistory(chart, history); }
      });
    } catch (error) { words.textContent = `It stopped: ${error.message}`; }
    button.textContent = "Start again";
  };
  save.onclick = () => savedAs(`${best.champion.name}-evolved`, best.text);
  play.onclick = async () => {
    const { champion, text } = best;
    try {
      const { state: found, motion } = await replayer.ask({ champion: text, poses: true }, () => {});
      state.offspring = simulated(champion, nameOf(champion, "evolved here"), motion, found);
      state.time = 0; restage(); setPlaying(true);
    } catch (error) { words.textContent = `It could not be simulated: ${error.message}`; }
  };
}

start();
