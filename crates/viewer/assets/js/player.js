// Playing: bins per second of wall time, whatever the screen's rate.

/** Speeds on offer [bins per second]. */
const SPEEDS = [1, 2, 5, 10, 20, 30, 60, 120];

const player = { last: null, part: 0, request: null };

/** One picture's worth of playing. */
function tick(v, now) {
  if (!state.playing) {
    player.request = null;
    return;
  }
  player.part += ((now - (player.last ?? now)) / 1000) * state.speed;
  player.last = now;
  const steps = Math.floor(player.part);
  if (steps > 0) {
    player.part -= steps;
    update({ bin: (state.bin + steps) % v.bins });
  }
  player.request = requestAnimationFrame((time) => tick(v, time));
}

function setPlaying(v, playing) {
  if (v.bins === 0) return;
  update({ playing });
  if (playing && player.request === null) {
    Object.assign(player, { last: null, part: 0 });
    player.request = requestAnimationFrame((time) => tick(v, time));
  }
}

/** Goes to a bin, within the window. */
function goTo(v, bin) {
  if (v.bins > 0) update({ bin: Math.min(v.bins - 1, Math.max(0, bin)) });
}

/** The next speed up (+1) or down (−1). */
function changeSpeed(direction) {
  const at = SPEEDS.indexOf(state.speed);
  update({ speed: SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, at + direction))] });
}
