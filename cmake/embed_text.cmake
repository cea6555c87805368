# Writes FILES (paths) as a C++ table from their path under ROOT to their text, so that the binary needs no data folder.
# The text is split into literals of bounded length: compilers limit one literal's size.
set(TABLE "")
foreach(FILE IN LISTS FILES)
  file(RELATIVE_PATH NAME ${ROOT} ${FILE})
  file(READ ${FILE} TEXT)
  string(LENGTH "${TEXT}" LENGTH)
  set(LITERALS "")
  set(OFFSET 0)
  while(OFFSET LESS LENGTH)
    string(SUBSTRING "${TEXT}" ${OFFSET} 8000 PART)
    string(APPEND LITERALS "R\"~~~(${PART})~~~\"\n")
    math(EXPR OFFSET "${OFFSET} + 8000")
  endwhile()
  string(APPEND TABLE "    {\"${NAME}\",\n${LITERALS}},\n")
endforeach()
file(WRITE ${OUTPUT}.new "// Made by cmake/embed_text.cmake.
#include \"renderer/gl/shader_sources.h\"

namespace lightwell::gl {

const std::map<std::string, std::string, std::less<>>& embedded_shader_sources() {
  static const std::map<std::string, std::string, std::less<>> sources = {
${TABLE}  };
  return sources;
}

}  // namespace lightwell::gl
")
file(COPY_FILE ${OUTPUT}.new ${OUTPUT} ONLY_IF_DIFFERENT)
