# TUBECUT_SANITIZE is a comma list for -fsanitize, for example "address,undefined" or "thread".
set(TUBECUT_SANITIZE "" CACHE STRING "sanitizers for every target")
if(TUBECUT_SANITIZE)
  add_compile_definitions(TUBECUT_SANITIZED)
  add_compile_options(-fsanitize=${TUBECUT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${TUBECUT_SANITIZE})
endif()
