# Writes the file INPUT as a C++ function: FUNCTION (with its namespaces), declared in HEADER, gives its text.
# An array of numbers, not a literal: no compiler limits its size.
file(READ ${INPUT} HEX HEX)
string(REGEX REPLACE "(..)" "0x\\1," BYTES "${HEX}")
string(REGEX REPLACE "(................................................................................)" "\\1\n" BYTES "${BYTES}")
file(WRITE ${OUTPUT}.new "// Made by cmake/embed_document.cmake.
#include \"${HEADER}\"

namespace {
constexpr char kText[] = {${BYTES}0};
}  // namespace

std::string_view ${FUNCTION}() { return {kText, sizeof(kText) - 1}; }
")
file(COPY_FILE ${OUTPUT}.new ${OUTPUT} ONLY_IF_DIFFERENT)
