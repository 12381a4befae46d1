// SPDX-License-Identifier: MIT
// film.glsl - pixels of the picture, in which the sums of a frame's steps are kept until the last makes colours of them:
// as src/cpu/film.c. Needs common.glsl and the constant VISIBILITY.

const bool CATCHES = VISIBILITY == LAYOUT_SHADOWS_CAUGHT;

struct film_light {
    vec4 light;   // and whether object or plane were hit
    float object; // whether it was the object
    vec4 behind;  // the background behind the shadow catcher, and whether that was hit
    vec2 caught;  // the luminance that reaches it, and would without the object
};

film_light film_load(uint pixel)
{
    film_light sum = film_light(STEP.picture.at[pixel], STEP.object.at[pixel], vec4(0.0), vec2(0.0));
    if (CATCHES) {
        sum.behind = STEP.caught.at[2u * pixel];
        const vec4 caught = STEP.caught.at[2u * pixel + 1u];
        sum.caught = caught.xy;
    }
    return sum;
}

film_light film_scaled(film_light sum, float times, float parts)
{
    return film_light(sum.light * times / parts, sum.object * times / parts, sum.behind * times / parts,
                      sum.caught * times / parts);
}

film_light film_sum(film_light a, film_light b)
{
    return film_light(a.light + b.light, a.object + b.object, a.behind + b.behind, a.caught + b.caught);
}

void film_develop(uint pixel, film_light sum)
{
    if (CATCHES) {
        const float lit = sum.caught.y > 0.0 ? sum.caught.x / sum.caught.y : 1.0;
        sum.light += vec4(sum.behind.rgb * lit, sum.behind.a * (1.0 - lit));
    }
    if (STEP.shows_background != 0u)
        sum.light.a = 1.0;
    STEP.picture.at[pixel] = sum.light;
    STEP.object.at[pixel] = sum.object;
}

void film_store(uint pixel, film_light sum)
{
    STEP.picture.at[pixel] = sum.light;
    STEP.object.at[pixel] = sum.object;
    if (CATCHES) {
        STEP.caught.at[2u * pixel] = sum.behind;
        STEP.caught.at[2u * pixel + 1u] = vec4(sum.caught, 0.0, 0.0);
    }
}

void film_keep(uint pixel, film_light sum)
{
    const bool is_first = STEP.is_first != 0u, is_last = STEP.is_last != 0u;
    if (!is_first || !is_last) // else it is the only one
        sum = film_scaled(sum, float(STEP.samples), 1.0);
    if (!is_first)
        sum = film_sum(sum, film_load(pixel));
    if (!is_last)
        film_store(pixel, sum);
    else
        film_develop(pixel, is_first ? sum : film_scaled(sum, 1.0, STEP.weight));
}

// Adds a camera sample's light to a pixel. covered: object or plane were hit; object: the object.
void film_add(uint pixel, vec3 radiance, bool covered, bool object)
{
    film_keep(pixel, film_light(vec4(radiance, covered ? 1.0 : 0.0), object ? 1.0 : 0.0, vec4(0.0), vec2(0.0)));
}

// The same where it hit the shadow catcher, before this background.
void film_catch(uint pixel, vec3 background, vec2 luminances)
{
    film_keep(pixel, film_light(vec4(0.0), 0.0, vec4(background, 1.0), luminances));
}
