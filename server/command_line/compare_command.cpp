#include "server/command_line/compare_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "renderer/image_io/image_io.h"
#include "renderer/image_metrics/compare.h"
#include "renderer/image_metrics/heatmap.h"
#include "server/command_line/output_file.h"

namespace lightwell {

namespace {

Result<metrics::Picture> read_picture(const std::string& path) {
  Result<FloatImage> image = read_image(path);
  if (!image) return image.error();
  metrics::Picture picture{image->size_px.x, image->size_px.y, {}, !is_scene_referred(path)};
  const std::size_t channels = static_cast<std::size_t>(image->channels);
  picture.rgb.reserve(picture.pixel_count() * 3);
  for (std::size_t i = 0; i + channels <= image->pixels.size(); i += channels)
    picture.rgb.insert(picture.rgb.end(), image->pixels.begin() + static_cast<std::ptrdiff_t>(i),
                       image->pixels.begin() + static_cast<std::ptrdiff_t>(i + 3));
  return picture;
}

nlohmann::json to_json(const CompareArguments& arguments, const metrics::Comparison& comparison) {
  nlohmann::json json = {{"picture", arguments.picture},
                         {"reference", arguments.reference},
                         {"width", comparison.error_map.width},
                         {"height", comparison.error_map.height},
                         {"rel_mse", comparison.linear.rel_mse},
                         {"rel_mse_trimmed", comparison.linear.rel_mse_trimmed},
                         {"mse", comparison.linear.mse},
                         {"mean_signed_error", comparison.linear.mean_signed_error},
                         {"reference_mean", comparison.linear.reference_mean},
                         {"psnr_db", comparison.psnr_db},  // infinite is written as null
                         {"ssim", nullptr},
                         {"flip", comparison.flip},
                         {"hdr_flip", nullptr}};
  if (comparison.ssim) json["ssim"] = *comparison.ssim;
  if (comparison.hdr_flip) {
    const metrics::ExposureRange& range = comparison.hdr_exposures;
    json["hdr_flip"] = *comparison.hdr_flip;
    json["hdr_flip_exposures"] = {{"start", range.start}, {"stop", range.stop}, {"count", range.count}};
  }
  return json;
}

void print_text(const metrics::Comparison& comparison) {
  const metrics::LinearErrors& linear = comparison.linear;
  std::printf("relMSE              %.6g\n", linear.rel_mse);
  std::printf("  without top 0.1%%  %.6g\n", linear.rel_mse_trimmed);
  std::printf("MSE                 %.6g\n", linear.mse);
  std::printf("mean signed error   %+.6g %+.6g %+.6g (R G B)\n", linear.mean_signed_error[0],
              linear.mean_signed_error[1], linear.mean_signed_error[2]);
  std::printf("mean of reference    %.6g %.6g %.6g\n", linear.reference_mean[0], linear.reference_mean[1],
              linear.reference_mean[2]);
  std::printf("PSNR                %.2f dB\n", comparison.psnr_db);
  if (comparison.ssim) std::printf("SSIM                %.5f\n", *comparison.ssim);
  std::printf("FLIP                %.5f\n", comparison.flip);
  if (comparison.hdr_flip)
    std::printf("HDR-FLIP            %.5f (%d exposures, %+.1f to %+.1f stops)\n", *comparison.hdr_flip,
                comparison.hdr_exposures.count, comparison.hdr_exposures.start, comparison.hdr_exposures.stop);
}

}  // namespace

void add_compare_options(CLI::App& app, CompareArguments& arguments) {
  app.add_option("A", arguments.picture, "The picture to judge")->required();
  app.add_option("B", arguments.reference, "The reference, of the same size and kind")->required();
  app.add_option("--heatmap", arguments.heatmap, "Write where they differ (FLIP) as a .png or .jpg")->type_name("FILE");
  app.add_flag("--json", arguments.json, "Print JSON");
}

ExitCode run_compare(const CompareArguments& arguments) {
  if (!arguments.heatmap.empty()) {
    const auto format = output_format_of(arguments.heatmap);
    if (!format || *format == OutputFormat::kExr)
      return report_usage(invalid_input("--heatmap", "\"" + arguments.heatmap + "\" does not end in .png or .jpg"));
    if (const Status status = check_folder_of(arguments.heatmap); !status) return report(status.error());
  }
  const Result<metrics::Picture> picture = read_picture(arguments.picture);
  if (!picture) return report(picture.error());
  const Result<metrics::Picture> reference = read_picture(arguments.reference);
  if (!reference) return report(reference.error());
  const Result<metrics::Comparison> comparison = metrics::compare(*picture, *reference);
  if (!comparison) return report(comparison.error());
  if (!arguments.heatmap.empty()) {
    const Status written =
        write_ldr(arguments.heatmap, {picture->width, picture->height}, metrics::heatmap(comparison->error_map));
    if (!written) return report(written.error());
  }
  if (arguments.json)
    std::printf("%s\n", to_json(arguments, *comparison).dump(2).c_str());
  else
    print_text(*comparison);
  return kDone;
}

}  // namespace lightwell
