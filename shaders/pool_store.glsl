// SPDX-License-Identifier: MIT
// pool_store.glsl - how samples lie in pools. Needs common.glsl.

const float GREATEST_FLOAT = 3.40282347e38;

// Radiance / density; finite, so that times 0 it is 0.
vec3 weighted(vec3 radiance, float density)
{
    return min(radiance / density, vec3(GREATEST_FLOAT));
}

// tile: of pools of bins; else 0.
void store_sample(uint index, vec3 direction, float density, vec3 light, uint tile)
{
    STATE.pools.at[index] = vec4(direction, density);
    STATE.pools.at[STATE.pool_stride + index] = vec4(light, float(tile));
}
