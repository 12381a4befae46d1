// SPDX-License-Identifier: MIT
// film.glsl - pixels of the picture, in which the sums of a frame's steps are kept until the last makes colours of them.
// Needs common.glsl.

// Adds a camera sample's light to a pixel. covered: object or plane were hit; object: the object.
void film_add(uint pixel, vec3 radiance, bool covered, bool object)
{
    const float weight = float(STEP.samples);
    vec4 light = vec4(radiance, covered ? 1.0 : 0.0);
    float share = object ? 1.0 : 0.0;
    if (STEP.is_first == 0u || STEP.is_last == 0u) { // else it is the only one
        light *= weight;
        share *= weight;
        if (STEP.is_first == 0u) {
            light += STEP.picture.at[pixel];
            share += STEP.object.at[pixel];
        }
        if (STEP.is_last != 0u) {
            light /= STEP.weight;
            share /= STEP.weight;
        }
    }
    if (STEP.is_last != 0u && STEP.shows_background != 0u)
        light.a = 1.0;
    STEP.picture.at[pixel] = light;
    STEP.object.at[pixel] = share;
}
