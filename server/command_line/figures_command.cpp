#include "server/command_line/figures_command.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "renderer/image_io/image_io.h"
#include "renderer/image_io/label.h"
#include "renderer/scene/builtin.h"
#include "renderer/tracing/embree/embree_tracer.h"
#include "server/command_line/add_option.h"
#include "server/command_line/progress.h"
#include "server/command_line/thesis/figure_sheet.h"
#include "server/command_line/thesis/frame_request.h"
#include "server/command_line/thesis/picture_options.h"

namespace lightwell {

namespace {

// The small sheets are for pages of text: not larger than this, whatever their grid.
constexpr glm::ivec2 kSmallSheet_px(800, 900);
constexpr int kSmallSheetQuality = 80;
// Enough to know how bright a picture is.
constexpr int kExposureSamples = 32, kExposureIndirectSide_px = 128;

RgbImage image_of(const Frame& frame) {
  RgbImage image{frame.size_px, {}};
  for (std::size_t i = 0; i < frame.display_rgbx.size(); i += 4)
    image.rgb.insert(image.rgb.end(), &frame.display_rgbx[i], &frame.display_rgbx[i] + 3);
  return image;
}

struct Figures {
  const FiguresArguments& arguments;
  Renderer renderer{{{arguments.device}, arguments.tracer, [] { return make_embree_tracer(); }}};
  Progress progress{};

  Settings settings_for(int samples, int indirect_side_px) const {
    Settings settings = arguments.settings;
    settings.indirect_size = scaled_indirect_side(indirect_side_px, arguments.side_px);
    settings.samples = std::max(samples, 1);
    if (samples == 0) settings.bounces = 0;
    return settings;
  }

  Result<Frame> frame_of(const Scene& scene, double time_s, const Settings& settings) {
    const std::unique_ptr<RenderView> view = renderer.make_view();
    return renderer.render(scene, square_frame(scene, time_s, arguments.side_px, settings), *view);
  }

  // One for all pictures of a figure, so that they can be compared: the mean of what its moments ask for by themselves.
  Result<float> exposure_ev(const Scene& scene, const Figure& figure) {
    float sum = 0.0f;
    int moments = 0;
    double last_s = -1.0;
    for (const auto& panel : figure.cells) {
      if (!panel || panel->time_s == std::exchange(last_s, panel->time_s)) continue;
      const Result<Frame> frame =
          frame_of(scene, panel->time_s, settings_for(kExposureSamples, kExposureIndirectSide_px));
      if (!frame) return frame.error();
      sum += frame->exposure_ev;
      ++moments;
    }
    return sum / static_cast<float>(std::max(moments, 1));
  }

  Result<CaptionedImage> make_panel(const Scene& scene, const Figure& figure, const FigurePanel& panel, float ev) {
    Settings settings = settings_for(panel.samples, panel.indirect_side_px);
    settings.view = panel.view;
    settings.exposure_ev = ev;
    const Result<Frame> frame = frame_of(scene, panel.time_s, settings);
    if (!frame) return frame.error();
    CaptionedImage captioned{image_of(*frame), panel.caption};
    if (Status written = write(captioned.image, figure.number + "-" + panel.name + ".png"); !written)
      return written.error();
    return captioned;
  }

  Status make(const Figure& figure) {
    const Result<Scene> scene = builtin_scene(figure.scene);
    if (!scene) return scene.error();
    progress.show("figure " + figure.number + ": exposure");
    const Result<float> ev = exposure_ev(*scene, figure);
    if (!ev) return ev.error();
    Sheet sheet{figure.title, figure.columns, {}};
    for (const auto& panel : figure.cells) {
      sheet.cells.emplace_back();
      if (!panel) continue;
      progress.show("figure " + figure.number + ", picture " + std::to_string(sheet.cells.size()) + " of " +
                    std::to_string(figure.cells.size()) + ": " + panel->caption);
      Result<CaptionedImage> captioned = make_panel(*scene, figure, *panel, *ev);
      if (!captioned) return captioned.error();
      sheet.cells.back() = std::move(*captioned);
    }
    return write_sheets(figure, sheet);
  }

  Status write_sheets(const Figure& figure, const Sheet& sheet) const {
    const Result<RgbImage> large = composed(sheet, arguments.side_px);
    if (!large) return large.error();
    if (Status written = write(*large, figure.number + ".png"); !written) return written;
    const Result<RgbImage> small = composed(sheet, std::min(arguments.side_px, largest_panel(sheet, kSmallSheet_px)));
    if (!small) return small.error();
    return write(*small, figure.number + "-small.jpg");
  }

  Status write(const RgbImage& image, const std::string& name) const {
    return write_ldr(std::filesystem::path(arguments.folder) / ("figure-" + name), image.size_px, image.rgb,
                     kSmallSheetQuality);
  }
};

// Found out before minutes of work, not after them.
ExitCode prepare(const FiguresArguments& arguments) {
  if (const Status status = check_picture_options(arguments.side_px, arguments.settings); !status)
    return report_usage(status.error());
  if (const Result<int> width = label_width("font", 12); !width)
    return report(Error{ErrorKind::kInternal, width.error().where, width.error().what});
  std::error_code error;
  std::filesystem::create_directories(arguments.folder, error);
  if (!std::filesystem::is_directory(arguments.folder))
    return report(Error{ErrorKind::kInternal, arguments.folder, "is no folder and cannot be made one"});
  return kDone;
}

}  // namespace

void add_figures_options(CLI::App& app, FiguresArguments& arguments) {
  app.add_option("DIR", arguments.folder, "Where the pictures go; made if it does not exist")->required();
  add_parsed(app, "--only", arguments.figures, select_figures, "FIGURES", "Some of them, as in 6.1,6.5", "all");
  add_picture_options(app, arguments.side_px, arguments.settings, arguments.device, arguments.tracer);
}

ExitCode run_figures(const FiguresArguments& arguments) {
  if (const ExitCode code = prepare(arguments); code != kDone) return code;
  Figures figures{arguments};
  for (const Figure& figure : arguments.figures)
    if (const Status made = figures.make(figure); !made) return report(made.error());
  figures.progress.clear();
  std::fprintf(stderr, "lightwell: %zu figure%s in %s\n", arguments.figures.size(),
               arguments.figures.size() == 1 ? "" : "s", arguments.folder.c_str());
  return kDone;
}

}  // namespace lightwell
