add_library(tubecut_warnings INTERFACE)
target_compile_options(tubecut_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Woverloaded-virtual -Wold-style-cast -Wdouble-promotion -Werror
                       -Wno-missing-field-initializers)  # designated initialisers leave the rest to defaults
