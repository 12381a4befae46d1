// SPDX-License-Identifier: MIT
// control_point.glsl - what the control variate adds to a point: find_control() in src/sampling/estimate.c, without
// intensity. Needs point.glsl and control.glsl.

vec3 control_of(prepared_point p)
{
    if (LIGHT != LAYOUT_LIGHT_BINS || STEP.control_part == 0.0 || p.surface.kind != LAYOUT_DIFFUSE ||
        p.surface_expected > 0.0 || p.end[0] < LAYOUT_CONTROL_CHUNK)
        return vec3(0.0);
    const vec3 irradiance =
        control_difference(p.bin, p.from[0] - p.bin * STATE.pool_length, p.end[0], p.surface.normal);
    return STEP.control_part * brdf_value(p.surface, p.surface.normal, 1.0) * irradiance;
}
