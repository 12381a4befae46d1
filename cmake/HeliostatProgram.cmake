# The command-line program: build/heliostat.

find_package(PkgConfig REQUIRED)
pkg_check_modules(JANSSON QUIET IMPORTED_TARGET jansson)
if(NOT JANSSON_FOUND)
    message(FATAL_ERROR "jansson was not found: install libjansson-dev, or build without the program by "
                        "-DHELIO_BUILD_CLI=OFF.")
endif()

set(PROGRAM_SOURCES
    cli/asset.c cli/bench_camera.c cli/bench_cube.c cli/bench_curve.c cli/bench_device.c cli/bench_estimate.c cli/bench_flops.c
    cli/bench_frame.c cli/bench_json.c cli/bench_light.c cli/bench_machine.c cli/bench_memcpy.c cli/bench_mesh.c
    cli/bench_peak.c cli/bench_plan.c cli/bench_pools.c cli/bench_rays.c cli/bench_result.c cli/bench_run.c
    cli/bench_scene.c cli/bench_series.c cli/bench_table.c cli/bench_team.c cli/command_bench.c cli/command_compare.c cli/command_convert.c cli/command_info.c
    cli/compare_plan.c cli/compared_files.c cli/comparison_report.c cli/picture_file.c cli/picture_list.c
    cli/command_inspect.c cli/convert_plan.c cli/face.c cli/figure_path.c cli/input_source.c cli/inspect_json.c cli/inspect_judge.c
    cli/inspect_measure.c cli/inspect_spot.c cli/inspect_text.c cli/map_converter.c cli/map_shape.c cli/map_turn.c
    cli/command_render.c cli/command_samples.c cli/contact_sheet.c cli/day_exposure.c cli/finished_frame.c cli/frame_error.c cli/frame_label.c cli/frame_sink.c cli/frame_warnings.c cli/light_source.c
    cli/numbered_path.c cli/output_plan.c cli/render_job.c cli/render_sequence.c cli/sequence_report.c cli/sheet_labels.c cli/shown_picture.c
    cli/help.c cli/help_texts.c cli/interrupt.c cli/json_file.c cli/list.c
    cli/machine.c cli/main.c cli/mesh_path.c cli/manual.c cli/message.c cli/number.c cli/option_table.c cli/options.c cli/output_file.c
    cli/command_reference.c cli/narrow_light.c cli/reference_plan.c cli/reference_report.c cli/reference_run.c
    cli/progress.c cli/render_plan.c cli/samples_gather.c cli/samples_json.c cli/samples_pixel.c cli/samples_plan.c
    cli/samples_words.c cli/stats.c cli/suggestion.c
    cli/canvas_svg.c cli/chart.c cli/command_study.c cli/data_uri.c cli/digest.c cli/false_colour.c cli/study_charts.c
    cli/study_csv.c cli/study_file.c cli/study_job.c cli/study_light.c cli/study_list.c cli/study_markdown.c cli/study_measure.c
    cli/study_page.c cli/study_picture.c cli/study_plan.c cli/study_progress.c cli/study_record.c cli/study_settings.c
    cli/study_strategy.c cli/study_summary.c cli/study_truth.c)

if(HELIO_WITH_CAIRO)
    pkg_check_modules(CAIRO QUIET IMPORTED_TARGET cairo)
    if(NOT CAIRO_FOUND)
        message(FATAL_ERROR "cairo was not found: install libcairo2-dev, or build without it by -DHELIO_WITH_CAIRO=OFF.")
    endif()
    list(APPEND PROGRAM_SOURCES cli/cube_cross.c cli/error_figure.c cli/figure.c cli/figure_text.c cli/inspect_chart.c cli/inspect_drawing.c cli/inspect_panel.c
         cli/inspect_picture.c cli/samples_bars.c cli/samples_figure.c cli/samples_map.c cli/samples_marks.c
         cli/samples_panel.c cli/samples_sheet.c cli/canvas_cairo.c cli/study_charts_pdf.c cli/study_sheets.c)
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_CAIRO=1)
else()
    list(APPEND PROGRAM_SOURCES cli/error_no_figure.c cli/inspect_no_picture.c cli/samples_no_picture.c cli/study_no_charts.c)
endif()

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

file(RELATIVE_PATH ASSET_DIR_RELATIVE "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_DATADIR}/heliostat")
add_executable(heliostat_program ${PROGRAM_SOURCES} ${PEAK_OBJECTS})
set_target_properties(heliostat_program PROPERTIES OUTPUT_NAME heliostat
                      RUNTIME_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
target_compile_definitions(heliostat_program PRIVATE
    ${FEATURE_DEFINITIONS}
    HELIOSTAT_ASSET_DIR_RELATIVE="${ASSET_DIR_RELATIVE}"
    HELIOSTAT_ASSET_DIR_SOURCE="${CMAKE_CURRENT_SOURCE_DIR}/assets"
    HELIOSTAT_ASSET_DIR_INSTALL="${CMAKE_INSTALL_FULL_DATADIR}/heliostat")
target_link_libraries(heliostat_program PRIVATE heliostat helio_flags PkgConfig::JANSSON Threads::Threads m)
if(HELIO_WITH_CAIRO)
    target_link_libraries(heliostat_program PRIVATE PkgConfig::CAIRO)
endif()
