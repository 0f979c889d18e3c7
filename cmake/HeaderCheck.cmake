# check-headers compiles alone every header of the layers that no source there includes first: the others are compiled alone by that
# source, without precompiled headers by clang-tidy. Not part of the default build: `./dev lint` builds it.
file(GLOB_RECURSE HEADERS RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/core/*.hpp ${PROJECT_SOURCE_DIR}/api/*.hpp ${PROJECT_SOURCE_DIR}/server/*.hpp)
file(GLOB_RECURSE SOURCES CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/core/*.cpp ${PROJECT_SOURCE_DIR}/api/*.cpp ${PROJECT_SOURCE_DIR}/server/*.cpp)
foreach(header IN LISTS HEADERS)
  file(STRINGS ${PROJECT_SOURCE_DIR}/${header} line REGEX "^[^/]" LIMIT_COUNT 1)  # after a comment on the module
  if(NOT line STREQUAL "#pragma once")
    message(FATAL_ERROR "${header}: its first line of code is not #pragma once")
  endif()
endforeach()
foreach(source IN LISTS SOURCES)
  file(STRINGS ${source} first REGEX "^#include" LIMIT_COUNT 1)
  if(first MATCHES "\"(.*)\"")
    list(REMOVE_ITEM HEADERS ${CMAKE_MATCH_1})
  endif()
endforeach()
foreach(header IN LISTS HEADERS)
  set(alone ${PROJECT_BINARY_DIR}/headers/${header}.cpp)
  file(CONFIGURE OUTPUT ${alone} CONTENT "#include \"@header@\"\n" @ONLY)
  list(APPEND ALONE ${alone})
endforeach()
list(LENGTH HEADERS count)
message(STATUS "check-headers: ${count} that no source includes first")
add_library(check-headers OBJECT EXCLUDE_FROM_ALL ${ALONE})
target_compile_options(check-headers PRIVATE -O0 -g0)
target_link_libraries(check-headers PRIVATE tubecut_api tubecut_core fmt::fmt tubecut_warnings)
set_target_properties(check-headers PROPERTIES UNITY_BUILD OFF)  # because each header is compiled alone
