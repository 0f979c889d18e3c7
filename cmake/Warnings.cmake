# clang counts double to long double as promotion, which test oracles do on purpose; gcc does not.
# Designated initialisers leave the rest to defaults: hence no warning on missing initialisers.
add_library(tubecut_warnings INTERFACE)
target_compile_options(tubecut_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Woverloaded-virtual -Wold-style-cast $<$<CXX_COMPILER_ID:GNU>:-Wdouble-promotion>
                       -Wno-missing-field-initializers -Werror)
