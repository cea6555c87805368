// Binding points, read by C++ and GLSL alike: preprocessor lines only. Storage 0 to 7 belong to the tracers and to the
// pass at hand; what every pass may read has a place of its own.
#define BINDING_RAYS 0
#define BINDING_HITS 1
#define BINDING_HIT_WEIGHTS 2
#define BINDING_ARRIVING 3
#define BINDING_OUTPUT 4

#define BINDING_PATH_RAYS 0
#define BINDING_PATH_SHADOW_RAYS 1
#define BINDING_PATH_STATES 2
#define BINDING_PATH_PIXELS 3
#define BINDING_PATH_PENDING 4
#define BINDING_PATH_RADIANCE 5
#define BINDING_PATH_SLOTS 6
#define BINDING_PATH_COUNTS 7

#define BINDING_EXPOSURE 8
#define BINDING_HIT_DISPATCH 9

#define BINDING_CAMERA 0
#define BINDING_ENVIRONMENT 1
#define BINDING_LIGHTS 2

#define UNIT_TEXTURES_SRGB 0
#define UNIT_TEXTURES_LINEAR 4
#define UNIT_SHADOW_MOMENTS 8
#define UNIT_G_SURFACE 9
#define UNIT_G_MATERIAL 10
#define UNIT_G_EMISSION 11
#define UNIT_G_DEPTH 12
#define UNIT_IMAGE_A 14
#define UNIT_IMAGE_B 15
#define UNIT_IMAGE_C 16
#define UNIT_ENVIRONMENT 17
#define UNIT_VERTICES 18
#define UNIT_TRIANGLES 19
#define UNIT_INSTANCES 20
#define UNIT_MATERIALS 21
#define UNIT_RAYS 22
#define UNIT_HITS 23
#define UNIT_ARRIVING 25
#define UNIT_SAMPLE_POINTS 26
#define UNIT_GUIDE 27
#define UNIT_HIT_LIST 28
#define UNIT_ACTIVE_BLOCKS 29
#define UNIT_G_LOBES 30
#define UNIT_BRDF_TABLE 31
#define UNIT_LIGHT_TABLE 32
#define UNIT_LIGHT_CHOICES 33
#define UNIT_INSTANCE_LIGHTS 34
#define UNIT_PATH_STATES 35
#define UNIT_PATH_PIXELS 36
#define UNIT_PATH_SLOTS 37
#define UNIT_PATH_PENDING 38
#define UNIT_PATH_RADIANCE 39
#define UNIT_PATH_VISIBLE 40

#define TEXTURE_CLASSES 4
#define BRDF_TABLE_COLUMNS 64
#define BRDF_TABLE_GGX_ROWS 256
#define BRDF_TABLE_SHEEN_ROWS 64
#define MAX_SHADOW_LAYERS 32
#define MAX_LIGHTS 256

// Slots that one invocation of path_resolve.comp and path_compact.comp looks after.
#define PATH_CHUNK 64
