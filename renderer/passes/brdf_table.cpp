#include "renderer/passes/brdf_table.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

void BrdfTable::bind() {
  if (!table_) {
    constexpr std::uint32_t kRows = BRDF_TABLE_GGX_ROWS + BRDF_TABLE_SHEEN_ROWS;
    table_ = gl::Buffer("BRDF table", std::uint64_t{kRows} * BRDF_TABLE_COLUMNS * sizeof(glm::vec4));
    table_.bind_storage(BINDING_OUTPUT);
    shaders_.compute("passes/brdf_table.comp")->dispatch(kRows, 1u);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    texels_.attach(table_);
  }
  texels_.bind(UNIT_BRDF_TABLE);
}

}  // namespace lightwell
