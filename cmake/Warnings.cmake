# clang counts double to long double as promotion, which test oracles do on purpose; gcc does not.
# gcc 12 sees false overflows in std::string's operator+ (GCC bugs 105329, 105651) unless it parses that header in each source,
# and more or fewer of them by how long a path is written in as text; clang and AddressSanitizer look for true ones.
# More false ones come with optimisation, so warnings are errors in the presets that tests are built by, and a release builds.
# A unity build shows a local name that equals a neighbour's file-local one, which shadows nothing in its own source.
# Designated initialisers leave the rest to defaults: hence no warning on missing initialisers.
add_library(tubecut_warnings INTERFACE)
target_compile_options(tubecut_warnings INTERFACE -Wall -Wextra -Wpedantic $<$<NOT:$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wshadow> -Wnon-virtual-dtor
                       -Woverloaded-virtual -Wold-style-cast $<$<CXX_COMPILER_ID:GNU>:-Wdouble-promotion> $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds> $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread>
                       -Wno-missing-field-initializers)
