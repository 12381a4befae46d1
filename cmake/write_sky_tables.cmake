# cmake -DSKY_FOLDER=... -DSKY_TABLES=... -P write_sky_tables.cmake: the CSV tables of SKY_FOLDER as the arrays that
# src/env/sky_model.h declares. Their rows come in the order of the arrays' indices: channel, albedo, turbidity and, in
# the larger one, control point.
cmake_minimum_required(VERSION 3.22)

# count: rows that there must be.
function(read_rows file count result)
    file(STRINGS "${SKY_FOLDER}/${file}" lines REGEX "^[RGB],")
    list(LENGTH lines length)
    if(NOT length EQUAL count)
        message(FATAL_ERROR "${SKY_FOLDER}/${file} has ${length} rows, not ${count}: fetch assets/sky anew.")
    endif()
    set(rows "")
    foreach(line IN LISTS lines)
        string(REGEX REPLACE "^[RGB],([0-9]+,)+" "" numbers "${line}")
        string(APPEND rows "    ${numbers},\n")
    endforeach()
    set(${result} "${rows}" PARENT_SCOPE)
endfunction()

read_rows(hosek_wilkie_rgb_coeffs.csv 360 coefficients)
read_rows(hosek_wilkie_rgb_radiance.csv 60 radiances)
file(WRITE "${SKY_TABLES}" "/* Made from assets/sky: (c) 2012-2013 Lukas Hosek and Alexander Wilkie, BSD 3-Clause, see
 * assets/sky/LICENSE-hosek-wilkie.txt. */
#include \"env/sky_model.h\"

const double sky_coefficients[SKY_TABLE_ROWS * SKY_CONTROL_POINTS * SKY_COEFFICIENTS] = {
${coefficients}};

const double sky_radiances[SKY_TABLE_ROWS * SKY_CONTROL_POINTS] = {
${radiances}};
")
