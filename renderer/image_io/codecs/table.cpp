#include "renderer/image_io/codecs/codecs.h"

const lightwell::codecs::Table* lightwell_image_codecs() {
  using namespace lightwell::codecs;
  static constexpr Table kTable{&decode_image, &read_image,  &encode_exr, &encode_exr_layers,
                                &encode_ldr,   &label_width, &draw_label};
  return &kTable;
}
