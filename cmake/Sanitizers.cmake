# TUBECUT_SANITIZE is a comma list for -fsanitize, for example "address,undefined" or "thread".
set(TUBECUT_SANITIZE "" CACHE STRING "sanitizers for every target")
if(TUBECUT_SANITIZE)
  add_compile_definitions(TUBECUT_SANITIZED)
  add_compile_options(-fsanitize=${TUBECUT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if(TUBECUT_SANITIZE STREQUAL "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Asio has a fence round each handler, for threads that share a loop; here each loop has one. ThreadSanitizer does not see it.
    add_compile_options(-Wno-tsan)
  endif()
  add_link_options(-fsanitize=${TUBECUT_SANITIZE})
endif()
