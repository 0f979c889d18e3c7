# Same bits from every compiler and CPU: no contraction into FMA, no value-changing optimisation.
add_library(tubecut_numerics INTERFACE)
target_compile_options(tubecut_numerics INTERFACE -ffp-contract=off)
if("${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_RELEASE} ${CMAKE_CXX_FLAGS_DEBUG}" MATCHES "-ffast-math|-Ofast|-funsafe-math|-march=native")
  message(FATAL_ERROR "tubecut: -ffast-math, -Ofast and -march=native change result bits; remove them")
endif()
