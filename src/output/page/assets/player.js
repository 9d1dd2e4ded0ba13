// The time that all pictures and plots of a result show: a slider, and a button that plays.

/** Time in which a whole flight is played, s. */
const PLAYBACK_S = 20;

class Player {
  constructor(end, start) {
    Object.assign(this, { end, time: start, listeners: [], isPlaying: false });
    this.button = element("button", { type: "button", class: "play", onclick: () => this.toggle() }, "play");
    this.slider = element("input", {
      type: "range", min: 0, max: end, step: "any", value: start, "aria-label": "time, s",
      oninput: () => this.pauseAt(Number(this.slider.value)),
    });
    this.output = element("output", {}, seconds(start));
    this.node = element("div", { class: "player" }, this.button, this.slider, this.output);
  }

  onChange(listener) {
    this.listeners.push(listener);
  }

  /** Shows a time, s. */
  set(time) {
    this.time = Math.min(this.end, Math.max(0, time));
    this.slider.value = this.time;
    this.output.textContent = seconds(this.time);
    this.listeners.forEach((listener) => listener(this.time));
  }

  pauseAt(time) {
    this.pause();
    this.set(time);
  }

  toggle() {
    if (this.isPlaying) this.pause();
    else this.play();
  }

  pause() {
    this.isPlaying = false;
    this.button.textContent = "play";
  }

  /** From the present time, or from the start if that is the end; until the end, or until the page is left. */
  play() {
    this.isPlaying = true;
    this.button.textContent = "pause";
    if (this.time >= this.end) this.set(0);
    const speed = Math.max(1, this.end / PLAYBACK_S);
    let last = performance.now();
    const step = (now) => {
      if (!this.isPlaying || !this.node.isConnected) return;
      this.set(this.time + (speed * (now - last)) / 1000);
      last = now;
      if (this.time < this.end) requestAnimationFrame(step);
      else this.pause();
    };
    requestAnimationFrame(step);
  }
}
