# Builds the kernel files once for each instruction set; adds the objects to KERNEL_OBJECTS, and to KERNEL_ISAS the set,
# with its lanes and options in KERNEL_LANES_... and KERNEL_OPTIONS_... for others who build for each. The program chooses at run
# time, so nothing but these files may be compiled for more than the target's baseline.

set(KERNEL_SOURCES
    src/cpu/background_kernel.c src/env/exposure_kernel.c src/env/fault_kernel.c src/env/resampling_kernel.c
    src/env/sky_kernel.c src/eval/face_points_kernel.c src/sampling/bins_kernel.c src/sampling/control_kernel.c
    src/sampling/light_kernel.c src/sampling/lobe_variance_kernel.c
    src/sampling/point_tiles_kernel.c src/sampling/points_kernel.c
    src/sampling/pools_kernel.c src/sampling/set_kernel.c src/sampling/surface_kernel.c
    src/sampling/tables_kernel.c src/sampling/tiles_kernel.c src/sampling/weigh_kernel.c)
set(KERNEL_OBJECTS "")
set(KERNEL_ISAS "")

# Only where rounding may differ from machine to machine; drawing and tables have the same bits everywhere.
set_source_files_properties(src/sampling/control_kernel.c src/sampling/light_kernel.c src/sampling/weigh_kernel.c PROPERTIES COMPILE_OPTIONS -ffp-contract=fast)

# Pools and points hold finite numbers: a greater-of becomes one instruction. No calls of memset for arrays of a few
# registers, and loops over the lanes of a register stay loops until they are made into vectors.
set_property(SOURCE src/sampling/light_kernel.c APPEND PROPERTY COMPILE_OPTIONS -ffinite-math-only
             $<$<C_COMPILER_ID:GNU>:-fno-tree-loop-distribute-patterns -fno-loop-unroll-and-jam>)

if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    target_compile_definitions(helio_flags INTERFACE HELIO_KERNELS_X86)
    set(X86_KERNELS ON)
else()
    set(X86_KERNELS OFF)
endif()

# -fopenmp-simd: loops marked "omp simd", without a run-time library. -fno-trapping-math: comparisons may become
# selections, as nobody looks at the floating-point flags. -Wno-pass-failed: clang tells of each loop that it leaves
# scalar, and it does not know how to make vectors of the tables' prefix sums.
function(heliostat_kernels isa lanes)
    add_library(kernels_${isa} OBJECT ${KERNEL_SOURCES})
    target_include_directories(kernels_${isa} PRIVATE include src)
    target_compile_definitions(kernels_${isa} PRIVATE HELIO_ISA=${isa} HELIO_LANES=${lanes} ${FEATURE_DEFINITIONS})
    target_compile_options(kernels_${isa} PRIVATE $<$<CONFIG:Release>:-O3> -fno-trapping-math -fno-signed-zeros
                           $<$<C_COMPILER_ID:Clang>:-Wno-pass-failed> ${ARGN})
    target_link_libraries(kernels_${isa} PRIVATE helio_flags)
    set(KERNEL_OBJECTS ${KERNEL_OBJECTS} $<TARGET_OBJECTS:kernels_${isa}> PARENT_SCOPE)
    set(KERNEL_ISAS ${KERNEL_ISAS} ${isa} PARENT_SCOPE)
    set(KERNEL_LANES_${isa} ${lanes} PARENT_SCOPE)
    set(KERNEL_OPTIONS_${isa} ${ARGN} PARENT_SCOPE)
endfunction()

heliostat_kernels(scalar 1 -Wno-unknown-pragmas -fno-tree-vectorize -fno-tree-slp-vectorize)
if(X86_KERNELS)
    heliostat_kernels(sse2 4 -fopenmp-simd)
    heliostat_kernels(avx2 8 -fopenmp-simd -mavx2 -mfma)
    heliostat_kernels(avx512 16 -fopenmp-simd -mavx512f -mavx512dq -mavx512bw -mavx512vl -mavx2 -mfma
                      -mprefer-vector-width=512)
else()
    heliostat_kernels(simd 4 -fopenmp-simd)
endif()
