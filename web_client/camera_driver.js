// Who has the camera: the scene's own, or the user, who takes it over with the first touch at the very view on the
// screen.

export class CameraDriver {
  /**
   * @param {object} model a SessionModel @param {object} orbit an OrbitCamera
   * @param {object} owner `push(input, at_ms)`, `rect()`: the picture's, `animate()`: run the camera's own motion
   */
  constructor(model, orbit, owner) {
    this.model = model;
    this.orbit = orbit;
    this.owner = owner;
    this.sent = "";           // the user's camera as it was last sent, to tell it from another's
    this.scene_camera = null; // what to go back to
  }

  /** The user is about to move the camera: takes over the view on the screen if it is not already the user's. */
  begin() {
    const { camera, view, bounds } = this.model;
    if (this.model.follows_scene_camera()) {
      this.scene_camera = camera;
      if (view) this.orbit.adopt(view, bounds);
    } else if (JSON.stringify(camera) !== this.sent) {
      this.orbit.adopt(camera, bounds, true);
    }
  }

  /** The orbit camera has moved. */
  moved(at_ms) {
    const view = this.orbit.view();
    const text = JSON.stringify(view);
    if (text === this.sent && !this.model.follows_scene_camera()) return;
    this.sent = text;
    this.owner.push({ camera: view }, at_ms);
  }

  /** Glides to where the whole scene is seen. */
  fit() {
    const rect = this.owner.rect();
    if (!this.model.bounds) return;
    this.begin();
    this.orbit.fit(this.model.bounds, rect.width / rect.height);
    this.owner.animate();
  }

  /** Back to the scene's camera; from there, stays at the present view. */
  toggle_follow() {
    this.orbit.stop();
    if (this.model.follows_scene_camera()) {
      this.begin();
      this.moved();
    } else {
      this.owner.push({ camera: this.scene_camera });
    }
  }

  /** Looks through one of the scene's cameras. @param {number} index */
  use(index) {
    this.orbit.stop();
    this.scene_camera = { index };
    this.owner.push({ camera: this.scene_camera });
  }

  /** Another scene: its cameras are others. */
  forget() {
    this.orbit.stop();
    this.scene_camera = null;
    this.sent = "";
  }
}
