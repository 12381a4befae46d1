# The command-line program: build/heliostat.

find_package(PkgConfig REQUIRED)
pkg_check_modules(JANSSON QUIET IMPORTED_TARGET jansson)
if(NOT JANSSON_FOUND)
    message(FATAL_ERROR "jansson was not found: install libjansson-dev, or build without the program by "
                        "-DHELIO_BUILD_CLI=OFF.")
endif()

set(PROGRAM_SOURCES
    cli/asset.c cli/bench_camera.c cli/bench_cube.c cli/bench_curve.c cli/bench_estimate.c cli/bench_flops.c
    cli/bench_frame.c cli/bench_json.c cli/bench_light.c cli/bench_machine.c cli/bench_memcpy.c cli/bench_mesh.c
    cli/bench_peak.c cli/bench_plan.c cli/bench_pools.c cli/bench_rays.c cli/bench_result.c cli/bench_run.c
    cli/bench_scene.c cli/bench_series.c cli/bench_table.c cli/bench_team.c cli/command_bench.c cli/command_info.c
    cli/command_render.c cli/environment_source.c cli/help.c cli/help_texts.c cli/interrupt.c cli/json_file.c cli/list.c
    cli/machine.c cli/main.c cli/manual.c cli/message.c cli/number.c cli/option_table.c cli/options.c cli/output_file.c
    cli/progress.c cli/render_plan.c cli/stats.c cli/suggestion.c)

# The arithmetic peak that bench compares with, for each instruction set as the kernels.
set(PEAK_OBJECTS "")
foreach(isa IN LISTS KERNEL_ISAS)
    add_library(bench_fma_${isa} OBJECT cli/bench_fma.c)
    target_compile_definitions(bench_fma_${isa} PRIVATE HELIO_ISA=${isa} HELIO_LANES=${KERNEL_LANES_${isa}})
    target_compile_options(bench_fma_${isa} PRIVATE $<$<CONFIG:Release>:-O3> ${KERNEL_OPTIONS_${isa}} -ffp-contract=fast)
    target_include_directories(bench_fma_${isa} PRIVATE include) # for the analyzer, which reads error.h first
    target_link_libraries(bench_fma_${isa} PRIVATE helio_flags)
    list(APPEND PEAK_OBJECTS $<TARGET_OBJECTS:bench_fma_${isa}>)
endforeach()

add_executable(heliostat_program ${PROGRAM_SOURCES} ${PEAK_OBJECTS})
set_target_properties(heliostat_program PROPERTIES OUTPUT_NAME heliostat
                      RUNTIME_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
target_compile_definitions(heliostat_program PRIVATE
    ${FEATURE_DEFINITIONS}
    HELIOSTAT_ASSET_DIR_SOURCE="${CMAKE_CURRENT_SOURCE_DIR}/assets"
    HELIOSTAT_ASSET_DIR_INSTALL="${CMAKE_INSTALL_FULL_DATADIR}/heliostat")
target_link_libraries(heliostat_program PRIVATE heliostat helio_flags PkgConfig::JANSSON Threads::Threads m)
