// Recorded poses: unpacked once, and interpolated at any moment.

// The digit that each letter stands for: the visible ones of ASCII without those that mean something in a page.
const DIGITS = new Uint8Array(128);
[...Array(94).keys()].map((letter) => letter + 33).filter((code) => !"\"'<>&\\`{}".includes(String.fromCharCode(code))).forEach((code, digit) => { DIGITS[code] = digit; });

// The bytes of a text in base 85: four of each five letters, or one fewer than letters of the last ones.
function bytesOf(text) {
  const bytes = new Uint8Array(Math.floor(text.length * 4 / 5));
  for (let from = 0, at = 0; from < text.length; from += 5) {
    let number = 0;
    for (let letter = from; letter < from + 5; letter++) number = number * 85 + (letter < text.length ? DIGITS[text.charCodeAt(letter)] : 84);
    for (let shift = 24; shift >= 0 && at < bytes.length; shift -= 8) bytes[at++] = number >>> shift;
  }
  return bytes;
}
function numbersOf(text) { return new Int16Array(bytesOf(text).buffer); }

// A champion of the page's data, with its numbers unpacked.
function unpacked(champion) {
  return { ...champion, poses: numbersOf(champion.poses), torques: numbersOf(champion.torques), duration: (champion.frames - 1) * champion.frame_s };
}

// The poses at a time in seconds: between two frames they are interpolated.
function posesAt(champion, time) {
  const parts = champion.parts.length, place = Math.max(0, Math.min(champion.frames - 1, time / champion.frame_s));
  const before = Math.floor(place), after = Math.min(before + 1, champion.frames - 1), share = place - before;
  const value = (frame, part, index) => champion.poses[(frame * parts + part) * 7 + index];
  return champion.parts.map((_, part) => {
    const at = [0, 1, 2].map((index) => (value(before, part, index) * (1 - share) + value(after, part, index) * share) * champion.unit_m);
    const [a, b] = [before, after].map((frame) => [3, 4, 5, 6].map((index) => value(frame, part, index)));
    const sign = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1 : 1;
    const turn = a.map((part, i) => part * (1 - share) + sign * b[i] * share), length = Math.hypot(...turn) || 1;
    return { at, turn: turn.map((part) => part / length) };
  });
}

// The number of a series at a time: that of the frame before.
function atTime(champion, series, time) { return series[Math.max(0, Math.min(series.length - 1, Math.floor(time / champion.frame_s + 1e-6)))]; }

// A champion that was simulated in the page: its motion as it comes from the core, step by step.
function simulated(champion, name, { poses, steps, energy }, state) {
  const frames = Math.floor(poses.length / (champion.parts.length * 7)), packed = new Int16Array(poses.length);
  // Its own unit: it may get further than its champion.
  let furthest = 1;
  for (let i = 0; i < poses.length; i++) if (i % 7 < 3) furthest = Math.max(furthest, Math.abs(poses[i]));
  const unit_m = furthest / 32767;
  for (let i = 0; i < poses.length; i++) packed[i] = Math.round(i % 7 < 3 ? poses[i] / unit_m : poses[i] * 32767);
  return { ...champion, name, poses: packed, unit_m, frames, frame_s: champion.step_s, duration: (frames - 1) * champion.step_s, steps, energy, torques: new Int16Array(0), state };
}
