// Mouse and fingers on the picture: read, select, pan, zoom.

/** Movement that makes a click a drag [CSS pixels]. */
const DRAG = 5;

function listenToPointers(v) {
  const { canvas } = stage;
  const pointers = new Map();
  let dragged = false;
  let pinch = null;

  const spread = () => {
    const [a, b] = [...pointers.values()];
    return {
      distance: Math.hypot(a.x - b.x, a.y - b.y),
      cell: cellAt(v, (a.x + b.x) / 2, (a.y + b.y) / 2),
    };
  };

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, startX: event.clientX, startY: event.clientY });
    if (pointers.size === 1) dragged = false;
    if (pointers.size === 2) pinch = spread();
    // Fingers that cannot pan leave the gesture to the page, which may scroll.
    if (event.pointerType === "mouse" || zoomOf(v).scale > 1) canvas.setPointerCapture(event.pointerId);
  });

  canvas.addEventListener("pointermove", (event) => {
    const pointer = pointers.get(event.pointerId);
    if (!pointer) {
      if (event.pointerType === "mouse") update({ hover: cellAt(v, event.clientX, event.clientY) });
      return;
    }
    const [dx, dy] = [event.clientX - pointer.x, event.clientY - pointer.y];
    pointer.x = event.clientX;
    pointer.y = event.clientY;
    if (Math.hypot(pointer.x - pointer.startX, pointer.y - pointer.startY) > DRAG) dragged = true;
    if (pointers.size === 2 && pinch) {
      dragged = true;
      const now = spread();
      if (pinch.distance > 0) zoomBy(v, now.distance / pinch.distance, now.cell);
      pinch = now;
    } else if (dragged && zoomOf(v).scale > 1) {
      const g = geometry(v);
      const ratio = canvas.width / canvas.clientWidth;
      const zoom = zoomOf(v);
      setZoom(v, zoom.scale, zoom.x - (dx * ratio) / g.cellWidth, zoom.y - (dy * ratio) / g.cellHeight);
    }
  });

  const release = (event) => {
    const pointer = pointers.get(event.pointerId);
    pointers.delete(event.pointerId);
    if (pointers.size < 2) pinch = null;
    if (!pointer || dragged || event.type === "pointercancel") return;
    const cell = cellAt(v, event.clientX, event.clientY);
    if (cell) select(v, cell);
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => update({ hover: null }));
  canvas.addEventListener("dblclick", () => setZoom(v, 1, 0, 0));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    zoomBy(v, 2 ** ((-event.deltaY * lines) / 300), cellAt(v, event.clientX, event.clientY));
  }, { passive: false });
}

/** Selects the pixel, and in streaks the time, of a cell. */
function select(v, cell) {
  update(v.view.place(v, cell.x, cell.y));
}
