// Play and pause, the scene's time, and whose camera the picture is seen through.

const kIcons = { play: "icons.svg#play", pause: "icons.svg#pause" };

export class Transport {
  /**
   * @param {object} model a SessionModel
   * @param {object} owner `push(input, at_ms)`; `follow()`: back to the scene's camera; `fit()`
   */
  constructor(model, owner) {
    this.model = model;
    this.owner = owner;
    this.play = document.getElementById("play-button");
    this.scrubber = document.getElementById("scrubber");
    this.clock = document.getElementById("clock");
    this.follow = document.getElementById("follow-button");
    this.was_playing = null;  // while the scrubber is held: whether to go on afterwards
    this.play.addEventListener("click", () => this.toggle());
    this.follow.addEventListener("click", () => owner.follow());
    document.getElementById("fit-button").addEventListener("click", () => owner.fit());
    this.scrubber.addEventListener("input", (event) => this.scrub(event.timeStamp));
    this.scrubber.addEventListener("change", () => this.let_go());
    model.subscribe((changed) => this.show(changed));
  }

  toggle() {
    this.owner.push({ playing: !this.model.playing });
  }

  /** The scene stands still under the hand and goes on afterwards, if it did before. */
  scrub(at_ms) {
    const input = { time_s: Number(this.scrubber.value) };
    if (this.was_playing === null) {
      this.was_playing = this.model.playing;
      input.playing = false;
    }
    this.owner.push(input, at_ms);
  }

  let_go() {
    if (this.was_playing) this.owner.push({ playing: true });
    this.was_playing = null;
  }

  show(changed) {
    const { model } = this;
    const duration_s = model.scene_entry().duration_s;
    const moves = duration_s > 0;
    if (changed.has("playing")) {
      this.play.ariaLabel = model.playing ? "Pause" : "Play";
      this.play.querySelector("use").setAttribute("href", model.playing ? kIcons.pause : kIcons.play);
    }
    if (changed.has("scene") || changed.has("scenes")) {
      this.play.disabled = this.scrubber.disabled = !moves;
      this.scrubber.max = moves ? duration_s : 1;
      this.scrubber.parentElement.classList.toggle("is-still", !moves);
    }
    if (changed.has("time_s") || changed.has("scene") || changed.has("scenes")) {
      const time_s = moves ? model.time_s % duration_s : 0;
      if (this.was_playing === null) this.scrubber.value = time_s;
      this.scrubber.style.setProperty("--filled", `${moves ? (100 * this.scrubber.value) / duration_s : 0}%`);
      const text = moves ? `${Number(this.scrubber.value).toFixed(1)} / ${duration_s.toFixed(1)} s` : "Still";
      if (this.clock.textContent !== text) this.clock.textContent = text;
      this.scrubber.setAttribute("aria-valuetext", text);
    }
    if (changed.has("camera")) this.follow.setAttribute("aria-pressed", String(model.follows_scene_camera()));
  }
}
