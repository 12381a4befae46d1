# Makes a C file of the sky model's tables in assets/sky; adds it to SOURCES.

set(SKY_FOLDER "${CMAKE_CURRENT_SOURCE_DIR}/assets/sky")
set(SKY_TABLES "${CMAKE_CURRENT_BINARY_DIR}/sky_tables.c")
add_custom_command(
    OUTPUT "${SKY_TABLES}"
    COMMAND ${CMAKE_COMMAND} -DSKY_FOLDER=${SKY_FOLDER} -DSKY_TABLES=${SKY_TABLES}
            -P "${CMAKE_CURRENT_SOURCE_DIR}/cmake/write_sky_tables.cmake"
    DEPENDS "${SKY_FOLDER}/hosek_wilkie_rgb_coeffs.csv" "${SKY_FOLDER}/hosek_wilkie_rgb_radiance.csv"
            cmake/write_sky_tables.cmake
    VERBATIM)
list(APPEND SOURCES "${SKY_TABLES}")
