# Writes FILES (paths) as a C++ table from their path under ROOT to their bytes, text or not.
# An array of numbers, not a literal: it holds any byte, and no compiler limits its size.
set(ARRAYS "")
set(TABLE "")
set(INDEX 0)
foreach(FILE IN LISTS FILES)
  file(RELATIVE_PATH NAME ${ROOT} ${FILE})
  file(READ ${FILE} HEX HEX)
  string(REGEX REPLACE "(..)" "0x\\1," BYTES "${HEX}")
  string(REGEX REPLACE "(................................................................................)" "\\1\n" BYTES "${BYTES}")
  # One element more than the file has: an empty array is no C++.
  string(APPEND ARRAYS "constexpr unsigned char kFile${INDEX}[] = {${BYTES}0};\n")
  string(APPEND TABLE "    {\"${NAME}\", kFile${INDEX}, sizeof(kFile${INDEX}) - 1},\n")
  math(EXPR INDEX "${INDEX} + 1")
endforeach()
file(WRITE ${OUTPUT}.new "// Made by cmake/embed_files.cmake.
#include \"web_client/embedded.h\"

namespace lightwell {
namespace {
${ARRAYS}}  // namespace

std::vector<EmbeddedFile> embedded_web_files() {
  return {
${TABLE}  };
}

}  // namespace lightwell
")
file(COPY_FILE ${OUTPUT}.new ${OUTPUT} ONLY_IF_DIFFERENT)
