/* SPDX-License-Identifier: MIT
 *
 * The direct beam of R. E. Bird and C. Riordan, "Simple Solar Spectral Model for Direct and Diffuse Irradiance on
 * Horizontal and Tilted Planes at the Earth's Surface for Cloudless Atmospheres", J. Climate and Applied Meteorology
 * 25, 1986 (SERI/TR-215-2436): Neckel and Labs' extraterrestrial spectrum through Rayleigh scattering, ozone and
 * aerosol. The air mass is that of Kasten and Young 1989. How much aerosol a turbidity stands for is told by A. J.
 * Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999. */
#include "env/sun_light.h"

#include "core/vector.h"
#include "image/colour.h"

#include <heliostat/sky.h>

#include <stddef.h>

/* Bird and Riordan, table 1, where the eye sees. */
static const struct spectrum_row {
    double wavelength; /* nm */
    double irradiance; /* at 1 AU outside the atmosphere, W m^-2 um^-1 */
    double ozone;      /* absorption, 1 / cm */
} spectrum[] = {
    {360, 975.9, 0},        {370, 1119.9, 0},       {380, 1103.8, 0},       {390, 1033.8, 0},
    {400, 1479.1, 0},       {410, 1701.3, 0},       {420, 1740.4, 0},       {430, 1587.2, 0},
    {440, 1837.0, 0},       {450, 2005.0, 0.003},   {460, 2043.0, 0.006},   {470, 1987.0, 0.009},
    {480, 2027.0, 0.014},   {490, 1896.0, 0.021},   {500, 1909.0, 0.030},   {510, 1927.0, 0.040},
    {520, 1831.0, 0.048},   {530, 1891.0, 0.063},   {540, 1898.0, 0.075},   {550, 1892.0, 0.085},
    {570, 1840.0, 0.120},   {593, 1768.0, 0.119},   {610, 1728.0, 0.120},   {630, 1658.0, 0.090},
    {656, 1524.0, 0.065},   {667.6, 1531.0, 0.051}, {690, 1420.0, 0.028},   {710, 1399.0, 0.018},
    {718, 1374.0, 0.015},   {724.4, 1373.0, 0.012}, {740, 1298.0, 0.010},   {752.5, 1269.0, 0.008},
    {757.5, 1245.0, 0.007}, {762.5, 1223.0, 0.006}, {767.5, 1205.0, 0.005}, {780, 1183.0, 0.0},
};

/* One lobe of the colour matching functions. */
static double lobe(double wavelength, double height, double centre, double below, double above)
{
    double t = (wavelength - centre) * (wavelength < centre ? below : above);
    return height * exp(-0.5 * t * t);
}

/* The CIE 1931 functions as fitted by C. Wyman, P.-P. Sloan, P. Shirley, "Simple Analytic Approximations to the CIE XYZ
 * Color Matching Functions", JCGT 2(2), 2013. */
static void match_colour(double wavelength, double xyz[3])
{
    xyz[0] = lobe(wavelength, 0.362, 442.0, 0.0624, 0.0374) + lobe(wavelength, 1.056, 599.8, 0.0264, 0.0323) +
             lobe(wavelength, -0.065, 501.1, 0.0490, 0.0382);
    xyz[1] = lobe(wavelength, 0.821, 568.8, 0.0213, 0.0247) + lobe(wavelength, 0.286, 530.9, 0.0613, 0.0322);
    xyz[2] = lobe(wavelength, 1.217, 437.0, 0.0845, 0.0278) + lobe(wavelength, 0.681, 459.0, 0.0385, 0.0725);
}

/* How much air, ozone and haze the beam crosses. */
typedef struct beam {
    double air_mass, ozone, haze; /* ozone: cm; haze: optical depth at 1 um */
} beam;

static beam find_beam(double elevation, double turbidity)
{
    const double ozone_thickness = 0.3, ozone_height = 22.0 / 6370.0; /* cm; of the Earth's radius */
    double up = sin(elevation * PI / 180.0), above = up > 0.0 ? up : 0.0;
    double air_mass = 1.0 / (up + 0.50572 * pow(elevation + 6.07995, -1.6364));
    double ozone_mass = (1.0 + ozone_height) / sqrt(above * above + 2.0 * ozone_height);
    return (beam){air_mass, ozone_thickness * ozone_mass, (0.04608 * turbidity - 0.04586) * air_mass};
}

static double transmittance(const beam *b, double wavelength, double ozone)
{
    double um = wavelength * 1e-3, square = um * um;
    double depth =
        b->air_mass / (square * square * (115.6406 - 1.335 / square)) + b->ozone * ozone + b->haze * pow(um, -1.3);
    return exp(-depth);
}

void sun_light_irradiance(double elevation, double turbidity, double distance, double rgb[3])
{
    enum { FIRST = 360, LAST = 780, STEP = 5 }; /* nm */
    beam b = find_beam(elevation, turbidity);
    double xyz[3] = {0};
    const struct spectrum_row *row = spectrum;
    for (int nm = FIRST; nm <= LAST; nm += STEP) {
        double wavelength = nm;
        while (row[1].wavelength < wavelength)
            row++;
        double part = (wavelength - row[0].wavelength) / (row[1].wavelength - row[0].wavelength), matching[3];
        double outside = row[0].irradiance + part * (row[1].irradiance - row[0].irradiance);
        double ozone = row[0].ozone + part * (row[1].ozone - row[0].ozone);
        double power = outside * transmittance(&b, wavelength, ozone) * STEP * 1e-3;
        match_colour(wavelength, matching);
        for (int i = 0; i < 3; i++)
            xyz[i] += power * matching[i];
    }
    /* A red sun is outside of what Rec. 709 can show: what would be negative is 0. */
    colour_matrix matrix = colour_xyz_to_rec709();
    double factor = 683.0 / HELIO_SKY_CANDELAS / (distance * distance);
    for (int i = 0; i < 3; i++) {
        const double *line = matrix.m[i];
        rgb[i] = fmax(0.0, factor * (line[0] * xyz[0] + line[1] * xyz[1] + line[2] * xyz[2]));
    }
}
