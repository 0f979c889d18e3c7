# What is shipped: a mistake in memory ends the process instead of going on. Sanitizers and the debugger's builds bring checks of
# their own. tools/check_hardened reads it back from the binary.
set(TUBECUT_HARDENED OFF)
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT TUBECUT_SANITIZE)
  set(TUBECUT_HARDENED ON)
  include(CheckPIESupported)
  check_pie_supported(LANGUAGES CXX)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  add_compile_definitions(_GLIBCXX_ASSERTIONS)  # an index out of range ends the process, in the tests as in production
  add_compile_options(-fstack-protector-strong -fstack-clash-protection -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  add_link_options(-Wl,-z,relro,-z,now,-z,noexecstack)
endif()
