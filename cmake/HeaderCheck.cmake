# check-headers compiles every header of the layers alone. Not part of the default build: `./dev lint` builds it.
file(GLOB_RECURSE HEADERS RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/core/*.hpp ${PROJECT_SOURCE_DIR}/api/*.hpp ${PROJECT_SOURCE_DIR}/server/*.hpp)
foreach(header IN LISTS HEADERS)
  # Twice: a header without a guard fails too.
  set(alone ${PROJECT_BINARY_DIR}/headers/${header}.cpp)
  file(CONFIGURE OUTPUT ${alone} CONTENT "#include \"@header@\"\n#include \"@header@\"\n" @ONLY)
  list(APPEND ALONE ${alone})
endforeach()
add_library(check-headers OBJECT EXCLUDE_FROM_ALL ${ALONE})
target_compile_options(check-headers PRIVATE -O0 -g0)
target_link_libraries(check-headers PRIVATE tubecut_api tubecut_core fmt::fmt tubecut_warnings)
