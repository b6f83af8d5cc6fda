// Times as people read them.

const SPEED_OF_LIGHT = 299792458;

/** How times are shown: a unit that suits the window, or numbers of bins. */
class TimeUnit {
  constructor(manifest) {
    const edges = manifest.edges;
    this.timed = manifest.timed;
    const last = edges.length ? Math.max(Math.abs(edges[0]), Math.abs(edges[edges.length - 1])) : 0;
    const seconds = last / SPEED_OF_LIGHT;
    const units = [["s", 1], ["ms", 1e-3], ["µs", 1e-6], ["ns", 1e-9], ["ps", 1e-12], ["fs", 1e-15]];
    const fits = units.find(([, size]) => seconds >= size) ?? units[units.length - 1];
    [this.name, this.size] = this.timed ? fits : ["bin", 1];
    // Enough decimals to tell neighbouring bins apart.
    const width = edges.length > 1 ? this.of((edges[edges.length - 1] - edges[0]) / (edges.length - 1)) : 1;
    this.decimals = Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(Math.abs(width)))));
  }

  /** OPL in metres (or a number of bins) in this unit. */
  of(opl) {
    return this.timed ? opl / SPEED_OF_LIGHT / this.size : opl;
  }

  /** A time; without a unit, the bin that it lies in. */
  text(opl) {
    if (!Number.isFinite(opl)) return "–";
    return this.timed ? `${this.of(opl).toFixed(this.decimals)} ${this.name}` : `bin ${Math.floor(opl)}`;
  }
}
