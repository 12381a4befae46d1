// SPDX-License-Identifier: MIT
// cube.glsl - the geometry of the cube: the functions of src/env/cube.h. Needs common.glsl.

struct cube_position {
    uint face;
    float u, v;
};

struct cube_meeting {
    uint face;
    float right, down, distance;
};

// On edges X wins over Y over Z.
cube_meeting cube_meet(vec3 d)
{
    vec3 a = abs(d);
    bool on_x = a.x >= a.y && a.x >= a.z, y_over_z = a.y >= a.z;
    float major = on_x ? d.x : y_over_z ? d.y : d.z, way = major < 0.0 ? -1.0 : 1.0;
    float right = on_x ? -way * d.z : y_over_z ? d.x : way * d.x;
    float down = !on_x && y_over_z ? way * d.z : -d.y;
    uint axis = on_x ? 0u : y_over_z ? 2u : 4u;
    return cube_meeting(axis + (major < 0.0 ? 1u : 0u), right, down, abs(major));
}

cube_position cube_project(vec3 d)
{
    cube_meeting at = cube_meet(d);
    precise float u = at.right / at.distance, v = at.down / at.distance;
    return cube_position(at.face, u, v);
}

// A direction, of any length, towards a point of a face.
vec3 cube_point(uint face, float u, float v)
{
    float way = (face & 1u) != 0u ? -1.0 : 1.0;
    if (face < 2u)
        return vec3(way, -v, -way * u);
    return face < 4u ? vec3(u, way, way * v) : vec3(way * u, -v, way);
}

vec3 cube_direction(uint face, float u, float v)
{
    precise float square = 1.0 + u * u + v * v;
    return cube_point(face, u, v) * (1.0 / sqrt(square));
}

uint cube_texel(float coordinate, uint size)
{
    precise float position = (coordinate + 1.0) * 0.5 * float(size);
    float last = float(size - 1u);
    position = position > 0.0 ? position : 0.0; // also NaN
    return uint(position < last ? position : last);
}

uint texel_index(uint face, uint row, uint column)
{
    return (face * STATE.size + row) * STATE.size + column;
}

vec3 texel_radiance(uint index)
{
    return STATE.cube.at[index];
}
