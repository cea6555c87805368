// From the parts of a frame to a scene-referred picture, and from it to eight bits a channel.
#pragma once

#include <optional>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/gather.h"
#include "renderer/passes/map_view.h"
#include "renderer/passes/pixel_lists.h"
#include "renderer/passes/punctual_light.h"
#include "renderer/passes/reconstruction.h"
#include "renderer/renderer.h"

namespace lightwell {

/// Scene-referred linear BT.709; a: 1 + luminance of all light on lit surfaces, 0 on the background, -1 where unlit.
struct Picture {
  gl::Texture image;              // RGBA32F
  std::uint32_t accumulated = 0;  // frames averaged in it
};

/// The sky, as shaders/environment.glsl reads it.
class EnvironmentBlock {
 public:
  EnvironmentBlock();
  void set(const Environment& environment, const std::optional<glm::vec3>& background);
  void bind() const;

 private:
  gl::Buffer block_;
  gl::Texture image_;
  std::shared_ptr<const ImageHdr> uploaded_;
};

/// What clear surfaces are before.
struct BehindClear {
  const Picture& picture;
  const gl::Texture& layers;  // of ClearLayersPass
};

/// Whether a view shows clear surfaces over what is behind them; the others are of what is behind alone.
bool shows_clear_surfaces(ViewKind view);

/// Direct and indirect light, or one of the views, into the picture.
class ComposePass {
 public:
  explicit ComposePass(gl::ShaderLibrary& shaders);
  /// `depth`: the G-buffer's, which tells surfaces from background.
  void resize(const gl::Texture& depth);
  /// The view and the way of scaling up are the settings'; `gathered` holds what the indirect map was made with.
  /// `accumulate`: average with the frames already in the picture.
  const Picture& run(const DeviceScene& scene, const GBuffer& g_buffer, const ShadowMaps& shadows,
                     const IndirectMap& indirect, const GatherPass& gathered, const MapViewPass& map_view,
                     const Settings& settings, bool accumulate);
  /// The same of the layer of clear surfaces, over the picture of what is behind them.
  const Picture& run_over(const BehindClear& behind, const DeviceScene& scene, const GBuffer& g_buffer,
                          const ShadowMaps& shadows, const IndirectMap& indirect, const GatherPass& gathered,
                          const Settings& settings, bool accumulate);
  /// The same with direct light by traced shadow rays and a map that was scaled with its guide; a view of light. Pixels
  /// that are to get rays of their own are put into `lists`, unless it is null.
  const Picture& run(const DeviceScene& scene, const GBuffer& g_buffer, const TracedLight& direct,
                     const ReconstructedMap& indirect, const PixelLists* lists, std::uint32_t frame_number,
                     const Settings& settings, bool accumulate);
  /// Clear surfaces over what is behind them, with direct light by traced shadow rays; all their pixels are put into
  /// `lists`, unless it is null. With lists, what is behind the surfaces of volumes is left to rays of their pixels.
  const Picture& run_over(const BehindClear& behind, const DeviceScene& scene, const GBuffer& g_buffer,
                          const TracedLight& direct, const PixelLists* lists, const Settings& settings,
                          bool accumulate);
  /// One of the views that are not of light, from what is in `view_map`.
  const Picture& show(const DeviceScene& scene, const GBuffer& g_buffer, const gl::Texture& view_map,
                      const Settings& settings, bool accumulate);
  const Picture& picture() const { return picture_; }

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p),
          view(p, "view"),
          unmatched_share(p, "unmatched_share"),
          most_unmatched(p, "most_unmatched"),
          frame_number(p, "frame_number") {}
    gl::ProgramPtr program;
    gl::Uniform<int> view;
    gl::Uniform<float> unmatched_share;
    gl::Uniform<std::uint32_t> most_unmatched, frame_number;
  };
  const Picture& draw(const gl::Defines& surfaces, const gl::Defines& background, const Settings& settings,
                      bool accumulate);
  void draw_surfaces(const gl::Defines& defines, const Settings& settings);
  void draw_background(const gl::Defines& defines, const Settings& settings);
  gl::Variants<Variant> surfaces_;
  struct Background {
    explicit Background(const gl::ProgramPtr& p) : program(p), shown(p, "shown"), tinted(p, "tinted") {}
    gl::ProgramPtr program;
    gl::Uniform<int> shown, tinted;
  };
  gl::Variants<Background> background_;
  Picture picture_;
  gl::Framebuffer framebuffer_;
  GLuint depth_id_ = 0;
  gl::EmptyVertexArray full_screen_;
};

/// Exposure, tone curve, sRGB.
class DisplayPass {
 public:
  explicit DisplayPass(gl::ShaderLibrary& shaders);
  /// Measures the picture's median luminance; `smoothing` is the share of the way towards it in this frame.
  void measure_exposure(const Picture& picture, float smoothing);
  void run(const Picture& picture, const Settings& settings);

  /// The last picture, 4 bytes a pixel; waits for it.
  std::vector<std::uint8_t> read_rgbx() const;
  /// Valid after gl::wait_for_device().
  float measured_exposure_ev() const;

 private:
  void resize(glm::ivec2 size_px);

  gl::ProgramPtr exposure_program_, display_program_;
  gl::Uniform<glm::ivec2> exposure_size_px_;
  gl::Uniform<float> smoothing_;
  gl::Uniform<int> mapping_, neutral_curve_;
  gl::Uniform<float> fixed_exposure_;
  gl::Buffer exposure_;
  gl::BufferTexture exposure_texel_{"exposure", GL_R32F};
  gl::Texture display_;
  gl::Framebuffer framebuffer_;
  gl::EmptyVertexArray full_screen_;
};

}  // namespace lightwell
