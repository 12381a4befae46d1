/* SPDX-License-Identifier: MIT */
#include "cpu/rays.h"

#include "core/context.h"
#include "scene/mesh.h"

#include <stdio.h>
#include <string.h>

#if HELIO_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

struct rays {
    helio_context *context;
    RTCDevice device;
    RTCScene scene;
    enum RTCError error; /* the first that Embree reported, and its words */
    char message[256];
};

static void note_error(void *user, enum RTCError code, const char *message)
{
    rays *r = user;
    if (r->error != RTC_ERROR_NONE)
        return;
    r->error = code;
    snprintf(r->message, sizeof r->message, "%s", message ? message : "no reason given");
}

static helio_status fail_embree(enum RTCError code, const char *message)
{
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        return fail(HELIO_ERR_MEMORY, "no memory to prepare the mesh for rays");
    if (code == RTC_ERROR_UNSUPPORTED_CPU)
        return fail(HELIO_ERR_UNSUPPORTED, "Embree does not support this processor: %s", message);
    return fail(HELIO_ERR_UNSUPPORTED, "Embree cannot prepare the mesh for rays: %s (error %d)", message, (int)code);
}

static helio_status create_device(rays *r)
{
    char config[32];
    snprintf(config, sizeof config, "threads=%u", helio_context_threads(r->context));
    r->device = rtcNewDevice(config);
    if (r->device == NULL)
        return fail_embree(rtcGetDeviceError(NULL), "no device");
    rtcSetDeviceErrorFunction(r->device, note_error, r);
    return HELIO_OK;
}

/* Triangles that count as degenerate shrink to a point, which no ray hits. Left as they are, rounding could give such a
 * sliver a face in any direction. */
static bool set_cleaned_triangles(RTCGeometry geometry, const helio_mesh *mesh)
{
    uint32_t *triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                  3 * sizeof(uint32_t), mesh->triangle_count);
    if (triangles == NULL)
        return false;
    memcpy(triangles, mesh->triangles, (size_t)mesh->triangle_count * 3 * sizeof(uint32_t));
    vec3 normal;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t *corners = triangles + 3 * (size_t)i;
        if (!mesh_triangle_normal(mesh, i, &normal))
            corners[1] = corners[2] = corners[0];
    }
    return true;
}

/* The mesh's own arrays are used where possible: helio_mesh_create() pads positions for reads of 16 bytes. */
static bool set_buffers(RTCGeometry geometry, const helio_mesh *mesh)
{
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh->positions, 0,
                               3 * sizeof(float), mesh->vertex_count);
    if (mesh->degenerate_triangles != 0)
        return set_cleaned_triangles(geometry, mesh);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles, 0,
                               3 * sizeof(uint32_t), mesh->triangle_count);
    return true;
}

static helio_status build_scene(rays *r, const helio_mesh *mesh)
{
    r->scene = rtcNewScene(r->device);
    RTCGeometry geometry = rtcNewGeometry(r->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (r->scene != NULL && geometry != NULL && set_buffers(geometry, mesh)) {
        /* Robust: no ray slips through the edge between two triangles. */
        rtcSetSceneFlags(r->scene, RTC_SCENE_FLAG_ROBUST);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(r->scene, geometry);
        rtcCommitScene(r->scene);
    }
    rtcReleaseGeometry(geometry);
    return r->error == RTC_ERROR_NONE ? HELIO_OK : fail_embree(r->error, r->message);
}

helio_status rays_create(helio_context *context, const helio_mesh *mesh, rays **out)
{
    *out = NULL;
    rays *r = context_allocate(context, 1, sizeof *r);
    if (r == NULL)
        return HELIO_ERR_MEMORY;
    r->context = context;
    helio_status status = create_device(r);
    if (status == HELIO_OK)
        status = build_scene(r, mesh);
    if (status != HELIO_OK) {
        rays_destroy(r);
        return status;
    }
    *out = r;
    return HELIO_OK;
}

void rays_destroy(rays *r)
{
    if (r == NULL)
        return;
    if (r->scene != NULL)
        rtcReleaseScene(r->scene);
    if (r->device != NULL)
        rtcReleaseDevice(r->device);
    context_release(r->context, r);
}

/* ---- one ray: the plain way, and the definition of the others --------------------------- */

static struct RTCRay make_ray(vec3 origin, vec3 direction)
{
    return (struct RTCRay){
        .org_x = origin.x,
        .org_y = origin.y,
        .org_z = origin.z,
        .dir_x = direction.x,
        .dir_y = direction.y,
        .dir_z = direction.z,
        .tfar = INFINITY,
        .mask = ~0u,
    };
}

static void trace_nearest(RTCScene scene, struct RTCRayHit *ray)
{
#if HELIO_EMBREE_MAJOR >= 4
    rtcIntersect1(scene, ray, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, ray);
#endif
}

static void trace_any(RTCScene scene, struct RTCRay *ray)
{
#if HELIO_EMBREE_MAJOR >= 4
    rtcOccluded1(scene, ray, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, ray);
#endif
}

bool rays_intersect(const rays *r, vec3 origin, vec3 direction, rays_hit *hit)
{
    struct RTCRayHit ray = {.ray = make_ray(origin, direction)};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    trace_nearest(r->scene, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *hit = (rays_hit){.triangle = ray.hit.primID, .u = ray.hit.u, .v = ray.hit.v, .distance = ray.ray.tfar};
    return true;
}

bool rays_occluded(const rays *r, vec3 origin, vec3 direction)
{
    struct RTCRay ray = make_ray(origin, direction);
    trace_any(r->scene, &ray);
    return ray.tfar < 0.0f; /* Embree's way to say that something was hit */
}

/* ---- many rays from one origin: in packets ---------------------------------------------- */

enum { PACKET = 8 };

/* Idle lanes repeat the first ray, so that there is nothing odd in them. */
static void fill_packet(vec3 origin, uint32_t count, const float *x, const float *y, const float *z, int valid[PACKET],
                        struct RTCRay8 *packet)
{
    for (uint32_t lane = 0; lane < PACKET; lane++) {
        uint32_t i = lane < count ? lane : 0;
        valid[lane] = lane < count ? -1 : 0;
        packet->org_x[lane] = origin.x;
        packet->org_y[lane] = origin.y;
        packet->org_z[lane] = origin.z;
        packet->tnear[lane] = 0.0f;
        packet->dir_x[lane] = x[i];
        packet->dir_y[lane] = y[i];
        packet->dir_z[lane] = z[i];
        packet->time[lane] = 0.0f;
        packet->tfar[lane] = INFINITY;
        packet->mask[lane] = ~0u;
        packet->id[lane] = 0;
        packet->flags[lane] = 0;
    }
}

static void trace_nearest_packet(RTCScene scene, const int *valid, struct RTCRayHit8 *packet)
{
#if HELIO_EMBREE_MAJOR >= 4
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, packet, &arguments);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, packet);
#endif
}

static void trace_any_packet(RTCScene scene, const int *valid, struct RTCRay8 *packet)
{
#if HELIO_EMBREE_MAJOR >= 4
    rtcOccluded8(valid, scene, packet, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded8(valid, scene, &context, packet);
#endif
}

static void intersect_packet(const rays *r, vec3 origin, uint32_t count, const float *x, const float *y, const float *z,
                             rays_hit *hits)
{
    _Alignas(32) int valid[PACKET];
    struct RTCRayHit8 packet;
    fill_packet(origin, count, x, y, z, valid, &packet.ray);
    for (uint32_t lane = 0; lane < PACKET; lane++)
        packet.hit.geomID[lane] = packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    trace_nearest_packet(r->scene, valid, &packet);
    for (uint32_t lane = 0; lane < count; lane++) {
        bool met = packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
        hits[lane] = (rays_hit){.triangle = met ? packet.hit.primID[lane] : RAYS_NOTHING,
                                .u = packet.hit.u[lane],
                                .v = packet.hit.v[lane],
                                .distance = packet.ray.tfar[lane]};
    }
}

static void occlude_packet(const rays *r, vec3 origin, uint32_t count, const float *x, const float *y, const float *z,
                           bool *occluded)
{
    _Alignas(32) int valid[PACKET];
    struct RTCRay8 packet;
    fill_packet(origin, count, x, y, z, valid, &packet);
    trace_any_packet(r->scene, valid, &packet);
    for (uint32_t lane = 0; lane < count; lane++)
        occluded[lane] = packet.tfar[lane] < 0.0f;
}

void rays_intersect_many(const rays *r, vec3 origin, uint32_t count, const float *x, const float *y, const float *z,
                         rays_hit *hits)
{
    uint32_t i = 0;
    for (; count - i > 1; i += count - i < PACKET ? count - i : PACKET)
        intersect_packet(r, origin, count - i < PACKET ? count - i : PACKET, x + i, y + i, z + i, hits + i);
    if (i < count && !rays_intersect(r, origin, (vec3){x[i], y[i], z[i]}, &hits[i]))
        hits[i].triangle = RAYS_NOTHING;
}

void rays_occluded_many(const rays *r, vec3 origin, uint32_t count, const float *x, const float *y, const float *z,
                        bool *occluded)
{
    uint32_t i = 0;
    for (; count - i > 1; i += count - i < PACKET ? count - i : PACKET)
        occlude_packet(r, origin, count - i < PACKET ? count - i : PACKET, x + i, y + i, z + i, occluded + i);
    if (i < count)
        occluded[i] = rays_occluded(r, origin, (vec3){x[i], y[i], z[i]});
}
