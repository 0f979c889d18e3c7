# What nearly every source includes and nobody here changes, parsed once. A source still names what it uses: clang-tidy and
# check-headers compile without (tools/tidy).
set(PRECOMPILED <algorithm> <array> <charconv> <cmath> <cstddef> <cstdint> <functional> <limits> <map> <memory> <numbers> <numeric>
    <optional> <set> <span> <stop_token> <string> <string_view> <tuple> <utility> <variant> <vector> <Eigen/Geometry> <tl/expected.hpp>)
add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # ccache asks for it
