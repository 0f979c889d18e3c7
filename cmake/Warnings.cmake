add_library(tubecut_warnings INTERFACE)
target_compile_options(tubecut_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Woverloaded-virtual -Wold-style-cast -Wdouble-promotion -Werror)
