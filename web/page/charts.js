// Charts on canvases: the torque strip, and the progress of an evolution.

function styled(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

// Makes a canvas as fine as the screen, and returns its drawing context and size in the page's pixels.
function prepared(canvas) {
  const scale = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = Math.max(1, Math.round(width * scale)); canvas.height = Math.max(1, Math.round(height * scale));
  const pen = canvas.getContext("2d");
  pen.scale(scale, scale); pen.font = "12px system-ui, sans-serif";
  return { pen, width, height };
}

// The torques of all joints over time, each in a row of its own, with a line at the present moment.
function drawStrip(canvas, champion, time) {
  const { pen, width, height } = prepared(canvas), joints = champion.limbs.at(-1), row = height / joints;
  const frames = champion.torques.length / (joints * 2), left = 34;
  for (let joint = 0; joint < joints; joint++) {
    const middle = row * (joint + 0.5);
    pen.fillStyle = styled("--weak"); pen.textBaseline = "middle"; pen.fillText(`${joint + 1}`, 4, middle);
    pen.strokeStyle = styled("--line"); pen.lineWidth = 1; pen.beginPath(); pen.moveTo(left, middle); pen.lineTo(width, middle); pen.stroke();
    for (const [axis, colour] of [[1, "--twist"], [0, "--bend"]]) {
      pen.strokeStyle = styled(colour); pen.lineWidth = axis === 0 ? 1.6 : 1; pen.beginPath();
      for (let frame = 0; frame < frames; frame++) {
        const x = left + (width - left) * frame / Math.max(1, frames - 1), y = middle - champion.torques[(frame * joints + joint) * 2 + axis] / 32767 * row * 0.46;
        if (frame === 0) pen.moveTo(x, y); else pen.lineTo(x, y);
      }
      pen.stroke();
    }
  }
  const now = left + (width - left) * Math.min(1, time / Math.max(champion.duration, 1e-9));
  pen.strokeStyle = styled("--text"); pen.lineWidth = 1.5; pen.beginPath(); pen.moveTo(now, 0); pen.lineTo(now, height); pen.stroke();
}

// The best fitness of each generation.
function drawHistory(canvas, values) {
  const { pen, width, height } = prepared(canvas), low = Math.min(...values), high = Math.max(...values), span = high - low || 1, left = 44;
  const x = (index) => left + (width - left - 8) * index / Math.max(1, values.length - 1), y = (value) => height - 16 - (height - 30) * (value - low) / span;
  pen.fillStyle = styled("--weak"); pen.fillText(high.toFixed(1), 2, y(high) + 4);
  if (high > low) pen.fillText(low.toFixed(1), 2, y(low) + 4);
  pen.strokeStyle = styled("--accent"); pen.lineWidth = 2; pen.beginPath();
  values.forEach((value, index) => (index === 0 ? pen.moveTo(x(index), y(value)) : pen.lineTo(x(index), y(value))));
  pen.stroke();
  pen.fillStyle = styled("--accent"); pen.beginPath(); pen.arc(x(values.length - 1), y(values.at(-1)), 3.5, 0, 7); pen.fill();
}
