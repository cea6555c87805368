// Hands on the picture: mouse, touch, wheel and arrow keys, told as turns, pans and zooms of the camera.
// Left or one finger turns; right, middle, shift or two fingers pan; wheel and pinch zoom to where they are.

const kTurnPerHeight = Math.PI * 1.1;  // radians for a drag over the picture's height
const kReleaseWindowMs = 80;           // the speed of a let-go turn is measured over this time
const kKeyTurn = 1.4;                  // radians per second
const kKeyPan = 0.6;                   // picture heights per second
const kKeyZoom = 1.6;                  // natural logarithm per second
const kKeyMotions = {  // right, down, nearer: what a dragging hand would do
  ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowUp: [0, -1, 0], ArrowDown: [0, 1, 0],
  "+": [0, 0, 1], "-": [0, 0, -1],
};
const kSameKeys = { "=": "+", _: "-" };  // with and without shift
const kFirstKeyStep = 1 / 60;            // seconds: a key that is only tapped moves the camera by this

export class Gestures {
  /**
   * @param {HTMLElement} element what is dragged on; keys count while it has the focus
   * @param {object} camera an OrbitCamera
   * @param {object} owner `rect()`: the picture in CSS pixels relative to `element`; `begin()`: the camera is about to
   *   be
   *   used; `moved(at_ms)`: it has changed
   */
  constructor(element, camera, owner) {
    this.element = element;
    this.camera = camera;
    this.owner = owner;
    this.pointers = new Map();
    this.keys = new Set();
    this.samples = [];
    this.last_tick_ms = 0;
    this.reduced_motion = matchMedia("(prefers-reduced-motion: reduce)");
    element.addEventListener("pointerdown", (event) => this.down(event));
    element.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
      element.addEventListener(name, (event) => this.up(event));
    }
    element.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    element.addEventListener("keydown", (event) => this.key_down(event));
    element.addEventListener("keyup", (event) => this.keys.delete(kSameKeys[event.key] ?? event.key));
    element.addEventListener("blur", () => this.keys.clear());
  }

  down(event) {
    if (event.target !== this.element) return;
    this.element.setPointerCapture(event.pointerId);
    this.camera.stop();
    this.samples = [];
    const pans = event.button === 1 || event.button === 2 || event.shiftKey || event.ctrlKey || event.metaKey;
    this.pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY, pans });
    this.element.classList.add("is-dragged");
    if (event.button === 1) event.preventDefault();  // no autoscroll
  }

  move(event) {
    const pointer = this.pointers.get(event.pointerId);
    if (!pointer) return;
    const right = event.offsetX - pointer.x;
    const down = event.offsetY - pointer.y;
    if (!right && !down) return;
    const rect = this.owner.rect();
    this.owner.begin();
    if (this.pointers.size >= 2) {
      this.pinch(pointer, event, rect);
    } else if (pointer.pans) {
      this.camera.pan(right, down, rect);
    } else {
      const per_px = kTurnPerHeight / rect.height;
      this.camera.turn(right * per_px, down * per_px);
      this.samples.push({ at_ms: event.timeStamp, right: right * per_px, up: down * per_px });
    }
    pointer.x = event.offsetX;
    pointer.y = event.offsetY;
    this.owner.moved(event.timeStamp);
  }

  /** One of two fingers moved: half of a pan of their middle, and a zoom by their distance. */
  pinch(pointer, event, rect) {
    const other = [...this.pointers.values()].find((entry) => entry !== pointer);
    const before = Math.hypot(pointer.x - other.x, pointer.y - other.y);
    const after = Math.hypot(event.offsetX - other.x, event.offsetY - other.y);
    const middle = { x: (event.offsetX + other.x) / 2, y: (event.offsetY + other.y) / 2 };
    this.samples = [];
    this.camera.pan((event.offsetX - pointer.x) / 2, (event.offsetY - pointer.y) / 2, rect);
    if (before > 8 && after > 8) this.camera.zoom(after / before, middle, rect);
  }

  up(event) {
    if (!this.pointers.delete(event.pointerId)) return;
    if (this.pointers.size > 0) return;
    this.element.classList.remove("is-dragged");
    const recent = this.samples.filter((sample) => event.timeStamp - sample.at_ms < kReleaseWindowMs);
    if (recent.length < 2 || this.reduced_motion.matches) return;
    const seconds = Math.max((event.timeStamp - recent[0].at_ms) / 1000, 0.01);
    const sum = (member) => recent.slice(1).reduce((total, sample) => total + sample[member], 0);
    this.camera.coast(sum("right") / seconds, sum("up") / seconds);
    this.animate();
  }

  wheel(event) {
    event.preventDefault();
    this.owner.begin();
    const lines_to_px = event.deltaMode === 1 ? 33 : event.deltaMode === 2 ? 400 : 1;
    const per_px = event.ctrlKey ? 0.01 : 0.0018;  // with ctrl it is a trackpad's pinch, whose steps are small
    const factor = Math.exp(-Math.max(-240, Math.min(240, event.deltaY * lines_to_px)) * per_px);
    this.camera.zoom_softly(factor, { x: event.offsetX, y: event.offsetY });
    this.animate();
  }

  key_down(event) {
    const key = kSameKeys[event.key] ?? event.key;
    if (!(key in kKeyMotions) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.shift = event.shiftKey;
    if (this.keys.has(key)) return;
    if (this.keys.size === 0) this.camera.stop();
    this.keys.add(key);
    this.advance_keys(kFirstKeyStep, this.owner.rect());
    this.owner.moved(event.timeStamp);
    this.animate();
  }

  /** Runs the camera's own motion, frame by frame, for as long as there is any. */
  animate() {
    if (this.last_tick_ms) return;
    this.last_tick_ms = performance.now();
    const tick = () => {
      const now_ms = performance.now();
      const seconds = Math.min((now_ms - this.last_tick_ms) / 1000, 0.1);
      this.last_tick_ms = now_ms;
      const rect = this.owner.rect();
      if (this.keys.size > 0) this.advance_keys(seconds, rect);
      this.camera.advance(seconds, rect);
      this.owner.moved(now_ms);
      if (this.keys.size > 0 || this.camera.moving()) requestAnimationFrame(tick);
      else this.last_tick_ms = 0;
    };
    requestAnimationFrame(tick);
  }

  advance_keys(seconds, rect) {
    this.owner.begin();
    for (const key of this.keys) {
      const [right, down, nearer] = kKeyMotions[key];
      const pan_px = kKeyPan * rect.height * seconds;
      if (this.shift) this.camera.pan(right * pan_px, down * pan_px, rect);
      else this.camera.turn(right * kKeyTurn * seconds, down * kKeyTurn * seconds);
      const middle = { x: rect.x + rect.width / 2, y: rect.y + rect.height / 2 };
      if (nearer) this.camera.zoom(Math.exp(nearer * kKeyZoom * seconds), middle, rect);
    }
  }
}
