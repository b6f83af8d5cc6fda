// What a page shows, in one object; whoever changes it calls `update`, whoever draws it listens.

const state = {};

const listeners = [];
let changed = new Set();
let scheduled = null;

/** Changes the state; listeners are called once, before the next picture. */
function update(changes) {
  for (const [name, value] of Object.entries(changes)) {
    if (state[name] !== value) {
      state[name] = value;
      changed.add(name);
    }
  }
  if (changed.size > 0 && scheduled === null) {
    scheduled = new Promise((resolve) => requestAnimationFrame(() => {
      const names = changed;
      changed = new Set();
      scheduled = null;
      for (const listener of listeners) listener(names);
      resolve();
    }));
  }
}

/** Calls `listener` when any of the named parts of the state has changed. */
function onChange(names, listener) {
  listeners.push((changes) => {
    if (names.some((name) => changes.has(name))) listener(changes);
  });
}

/** Resolves when everything is drawn. */
async function settled() {
  while (scheduled !== null) await scheduled;
}
