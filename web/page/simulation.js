// The core in a worker: the page sends commands and receives answers, and never waits.

// The worker's whole program; it is turned into text, so it uses nothing from outside.
function coreWorker() {
  let core = null, isStopped = false;
  const encoder = new TextEncoder(), decoder = new TextDecoder();
  const call = (command) => {
    const bytes = encoder.encode(JSON.stringify(command)), place = core.input(bytes.length);
    new Uint8Array(core.memory.buffer, place, bytes.length).set(bytes);
    const length = core.command();
    const answer = JSON.parse(decoder.decode(new Uint8Array(core.memory.buffer, core.output(), length)));
    if (answer.error) throw new Error(answer.error);
    return answer;
  };
  const rest = () => new Promise((resolve) => setTimeout(resolve, 0));
  const simulate = async (message) => {
    let state = call({ begin: { champion: message.champion, friction: message.friction } });
    const motion = { poses: [], steps: [], energy: [] };
    const record = () => {
      // A step that disqualifies has no poses.
      if (message.poses && state.poses.length > 0) { motion.poses.push(...state.poses); motion.steps.push(state.steps_climbed); motion.energy.push(state.energy_j); }
      delete state.poses;
    };
    record();
    // A recorded motion needs the state after each step.
    const steps = message.poses ? 1 : 30;
    while (!state.is_over) {
      for (let taken = 0; taken < 30 && !state.is_over; taken += steps) { state = call({ advance: { steps, poses: message.poses } }); record(); }
      postMessage({ id: message.id, progress: state.step / state.last_step });
      await rest();
    }
    postMessage({ id: message.id, state, motion });
  };
  const evolve = async (message) => {
    call({ evolve: { champion: message.champion, friction: message.friction, seed: message.seed, population: message.population } });
    isStopped = false;
    while (!isStopped) {
      const state = call("next");
      postMessage({ id: message.id, evolution: state, champion: state.is_better ? call("best").champion : null });
      await rest();
    }
    postMessage({ id: message.id, stopped: true });
  };
  onmessage = async ({ data }) => {
    try {
      if (data.module) { core = (await WebAssembly.instantiate(data.module, {})).exports; postMessage({ id: data.id, engine: call("engine").engine }); }
      else if (data.stop) isStopped = true;
      else if (data.evolve) await evolve(data);
      else await simulate(data);
    } catch (error) { postMessage({ id: data.id, error: String(error.message || error) }); }
  };
}

class Core {
  constructor(module) {
    const text = new Blob([`(${coreWorker})()`], { type: "text/javascript" });
    this.worker = new Worker(URL.createObjectURL(text));
    this.waiting = new Map(); this.next = 0; this.last = Promise.resolve();
    this.worker.onmessage = ({ data }) => this.waiting.get(data.id)?.(data);
    this.worker.onerror = (event) => this.waiting.forEach((tell, id) => tell({ id, error: event.message || "the core stopped" }));
    this.ready = this.ask({ module }, () => {});
  }

  // Sends a message after the answer to the one before, because the core simulates one thing at a time; `tell` hears of
  // progress; the promise ends with the answer.
  ask(message, tell) {
    const answer = this.last.then(() => this.send(message, tell));
    this.last = answer.catch(() => {});
    return answer;
  }

  send(message, tell) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, (data) => {
        if (data.error) { this.waiting.delete(id); reject(new Error(data.error)); }
        else if ("progress" in data || "evolution" in data) tell(data);
        else { this.waiting.delete(id); resolve(data); }
      });
      this.worker.postMessage({ ...message, id });
    });
  }

  stop() { this.worker.postMessage({ stop: true }); }
}

// The core's module, unpacked.
async function coreModule() {
  const packed = bytesOf(document.getElementById("core").textContent);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}
