# One place for what every target of the project is built with.
# All includes are written from the project's root: #include "renderer/scene/scene.h".

function(lightwell_flags target)
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR})
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast
                                           -Woverloaded-virtual -Wimplicit-fallthrough)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-restrict)  # g++ 12 warns falsely on string concatenation (PR 105651)
  endif()
  if(LIGHTWELL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(LIGHTWELL_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${LIGHTWELL_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${LIGHTWELL_SANITIZE})
  endif()
endfunction()

# lightwell_library(name GLOB <folder patterns...> PUBLIC <links...> PRIVATE <links...>)
function(lightwell_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(NOT ARG_SOURCES)
    add_library(${name} INTERFACE)
    return()
  endif()
  add_library(${name} STATIC ${ARG_SOURCES})
  lightwell_flags(${name})
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()

# For code whose own speed nobody notices and whose templates take long to optimise: JSON, the command line, tests.
function(lightwell_compile_quickly target)
  if(CMAKE_BUILD_TYPE STREQUAL RelWithDebInfo)
    target_compile_options(${target} PRIVATE -O1)
  endif()
endfunction()

# Code that brings many libraries, as a module that `user` loads from beside the program when it is first needed. In builds
# for sanitizers it is linked instead, and `user` knows by the definition `linked`: reports and coverage then need no
# module's symbols.
function(lightwell_module name)
  cmake_parse_arguments(ARG "" "USER;LINKED" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(LIGHTWELL_SANITIZE OR LIGHTWELL_FUZZERS)
    lightwell_library(${name} SOURCES ${ARG_SOURCES} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    target_link_libraries(${ARG_USER} PRIVATE ${name})
    target_compile_definitions(${ARG_USER} PRIVATE ${ARG_LINKED})
  else()
    add_library(${name} MODULE ${ARG_SOURCES})
    lightwell_flags(${name})
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
                                             CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_link_libraries(${name} PRIVATE glm::glm ${ARG_PRIVATE})
    add_dependencies(${ARG_USER} ${name})
  endif()
endfunction()
