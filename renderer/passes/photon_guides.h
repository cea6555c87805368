// Photons that tell paths where mirrors throw light from, since rays sampled by the BRDF of a matt surface
// seldom find it. They guide samples and light nothing themselves, so that paths stay unbiased whatever they tell:
// Jensen 1995, "Importance driven path tracing using the photon map"; with points in place of directions for the
// guides, which hold for all of a cell (Ruppert et al. 2020, "Robust fitting of parallax-aware mixtures for path
// guiding").
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/variants.h"
#include "renderer/methods/frame_context.h"
#include "renderer/passes/light_table.h"
#include "renderer/passes/photon_targets.h"

namespace lightwell {

class PhotonGuidesPass {
 public:
  /// `buffers`: where rays and hits live; host-visible for a native tracer.
  PhotonGuidesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);
  ~PhotonGuidesPass();

  /// Sends photons anew in the first frame of a picture and in some of those after it, if the settings ask for guides.
  /// The light table is bound. `defines`: what the shaders of paths must be able to do in this scene.
  void run(FrameContext& frame, const Scene& scene, const LightTable& lights, const gl::Defines& defines);

  /// Whether there is anything to be guided to; else paths need not ask.
  bool has_guides() const { return has_guides_; }

  /// Binds what shaders/photon_guides.glsl reads.
  void bind() const;
  float cell_m() const { return cell_m_; }

 private:
  struct Programs;
  struct Photons;

  void set_scale(const Pose& pose, const LightTable& lights);
  void start(const LightTable& lights, const gl::Defines& defines);
  void bounce(const gl::Defines& defines, std::uint32_t bounce);

  std::unique_ptr<Programs> programs_;
  std::unique_ptr<Photons> photons_;
  bool has_guides_ = false;
  float cell_m_ = 1.0f, flux_scale_ = 1.0f;
  std::uint32_t seed_ = 0;
};

}  // namespace lightwell
