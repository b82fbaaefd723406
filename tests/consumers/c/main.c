/*
 * Smoke test of the C interface, and an example of its use.
 *
 *     consumer_c DRAWING.json OUT.step
 *
 * makes a solid of the drawing, prints its volume, writes it, and then does everything wrong that
 * a caller can do. Exits with 0 if all went as the header says.
 */
#include <faceformer.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define EXPECT(condition)                                                              \
    do {                                                                               \
        if (!(condition)) {                                                            \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);    \
            failures++;                                                                \
        }                                                                              \
    } while (0)

/* A call that is given &message must return this status, with a message. */
#define REFUSED(expected, call)                                                        \
    do {                                                                               \
        char *message = (char *)&failures;                                             \
        FaceformerStatus status = (call);                                              \
        EXPECT(status == (expected) && message && message[0] != '\0');                 \
        printf("status %d: %s\n", (int)status, message ? message : "(no message)");    \
        faceformer_string_free(message);                                               \
    } while (0)

static char *read_file(const char *path, size_t *length) {
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    long size;
    if (file && fseek(file, 0, SEEK_END) == 0 && (size = ftell(file)) > 0) {
        rewind(file);
        text = malloc((size_t)size);
        *length = text ? fread(text, 1, (size_t)size, file) : 0;
    }
    if (file) {
        fclose(file);
    }
    return text;
}

static int contains(const uint8_t *bytes, size_t length, const char *text) {
    size_t size = strlen(text), i;
    for (i = 0; i + size <= length; i++) {
        if (memcmp(bytes + i, text, size) == 0) {
            return 1;
        }
    }
    return 0;
}

/* The number after a key in JSON text, enough for a test. */
static double number(const char *json, const char *key) {
    const char *at = strstr(json, key);
    return at ? strtod(at + strlen(key), NULL) : NAN;
}

static int32_t count(const char *stage, double share, void *user) {
    EXPECT(stage[0] != '\0' && share >= 0.0 && share <= 1.0);
    ++*(int *)user;
    return 1;
}

static int32_t stop(const char *stage, double share, void *user) {
    (void)stage, (void)share, (void)user;
    return 0;
}

/* Drawing to STEP; false if a step failed, which ends the way. */
static int whole_way(const char *json, size_t length, const char *step) {
    FaceformerDrawing *drawing = NULL;
    FaceformerFaces *faces = NULL, *again = NULL;
    FaceformerSolid *solid = NULL;
    char *message = NULL, *text = NULL;
    uint8_t *brep = NULL;
    size_t brep_length = 0;
    int calls = 0;
    const char options[] = "{\"scale\": 1.0}";

    int ok = faceformer_drawing_read(json, length, &drawing, &message) == FACEFORMER_STATUS_OK
        && faceformer_identify(drawing, NULL, 0, count, &calls, &faces, &message)
            == FACEFORMER_STATUS_OK
        && faceformer_faces_json(faces, &text, &message) == FACEFORMER_STATUS_OK
        && faceformer_faces_read(drawing, text, strlen(text), &again, &message)
            == FACEFORMER_STATUS_OK
        && faceformer_solid(drawing, again, options, strlen(options), count, &calls, &solid,
                            &message) == FACEFORMER_STATUS_OK;
    faceformer_string_free(text);
    text = NULL;
    /* A handle lives on without those that it was made from. */
    faceformer_drawing_free(drawing);
    faceformer_faces_free(faces);
    faceformer_faces_free(again);
    ok = ok && faceformer_solid_report(solid, &text, &message) == FACEFORMER_STATUS_OK
        && faceformer_solid_brep(solid, &brep, &brep_length, &message) == FACEFORMER_STATUS_OK
        && faceformer_solid_write(solid, step, "step", &message) == FACEFORMER_STATUS_OK;
    if (ok) {
        EXPECT(calls > 0);
        EXPECT(strstr(text, "\"partial\":false") != NULL);
        EXPECT(brep_length > 100 && contains(brep, brep_length, "CASCADE Topology V1"));
        printf("volume %.9g\n", number(text, "\"volume\":"));
        EXPECT(faceformer_solid_write(solid, "no/such/folder/x.step", "step", NULL)
               == FACEFORMER_STATUS_FAILED);
        REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_solid_write(solid, step, "gif", &message));
        REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_solid_write(solid, NULL, "step", &message));
    } else {
        fprintf(stderr, "failed: %s\n", message ? message : "(no message)");
    }
    faceformer_string_free(message);
    faceformer_string_free(text);
    faceformer_bytes_free(brep, brep_length);
    faceformer_solid_free(solid);
    return ok;
}

static void refuse_text(const char *json, size_t length) {
    FaceformerDrawing *drawing = (FaceformerDrawing *)&failures;
    REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_drawing_read(json, length, &drawing, &message));
    EXPECT(drawing == NULL);
}

static void wrong_ways(const char *json, size_t length) {
    static const char *const garbage[] = {
        "", "garbage", "{", "[1, 2", "{\"edges\": []}", "{\"edges\": 7}",
        "{\"edges\": [{\"points\": [[0, 0], [NaN, 1]]}]}",
        "{\"edges\": [{\"points\": [[0, 0], [1e999, 1]]}]}",
        "\xff\xfe\xfd",
    };
    FaceformerDrawing *drawing = NULL, *other = NULL;
    FaceformerFaces *faces = NULL;
    FaceformerSolid *solid = NULL;
    char *text = NULL;
    size_t i;

    for (i = 0; i < sizeof garbage / sizeof *garbage; i++) {
        refuse_text(garbage[i], strlen(garbage[i]));
    }
    refuse_text(NULL, 0);
    refuse_text(NULL, 5);
    refuse_text(json, (size_t)-1);
    REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_drawing_read(json, length, NULL, &message));
    EXPECT(faceformer_drawing_read(NULL, 0, NULL, NULL) == FACEFORMER_STATUS_BAD_INPUT);

    EXPECT(faceformer_drawing_read(json, length, &drawing, NULL) == FACEFORMER_STATUS_OK);
    EXPECT(faceformer_drawing_read(json, length, &other, NULL) == FACEFORMER_STATUS_OK);
    REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_identify(NULL, NULL, 0, NULL, NULL, &faces, &message));
    REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_identify(drawing, "{\"engine\":\"magic\"}", 18, NULL, NULL, &faces, &message));
    REFUSED(FACEFORMER_STATUS_CANCELLED, faceformer_identify(drawing, NULL, 0, stop, NULL, &faces, &message));
    REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_faces_read(drawing, "{}", 2, &faces, &message));
    EXPECT(faces == NULL);

    EXPECT(faceformer_identify(other, NULL, 0, NULL, NULL, &faces, NULL) == FACEFORMER_STATUS_OK);
    REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_solid(drawing, faces, NULL, 0, NULL, NULL, &solid, &message));
    REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_solid(other, faces, "{\"scale\":-1}", 12, NULL, NULL, &solid, &message));
    REFUSED(FACEFORMER_STATUS_CANCELLED, faceformer_solid(other, faces, NULL, 0, stop, NULL, &solid, &message));
    EXPECT(solid == NULL);
    REFUSED(FACEFORMER_STATUS_BAD_INPUT, faceformer_solid_report(NULL, &text, &message));
    EXPECT(text == NULL);
    EXPECT(faceformer_drawing_report(drawing, NULL, NULL) == FACEFORMER_STATUS_BAD_INPUT);
    EXPECT(faceformer_solid_brep(NULL, NULL, NULL, NULL) == FACEFORMER_STATUS_BAD_INPUT);

    faceformer_drawing_free(drawing);
    faceformer_drawing_free(other);
    faceformer_faces_free(faces);
    faceformer_drawing_free(NULL);
    faceformer_faces_free(NULL);
    faceformer_solid_free(NULL);
    faceformer_string_free(NULL);
    faceformer_bytes_free(NULL, 3);
}

int main(int argc, char **argv) {
    char *json, *info = NULL;
    size_t length = 0;
    if (argc != 3) {
        fprintf(stderr, "usage: consumer_c DRAWING.json OUT.step\n");
        return 2;
    }
    json = read_file(argv[1], &length);
    if (!json) {
        fprintf(stderr, "cannot read %s\n", argv[1]);
        return 2;
    }
    EXPECT(faceformer_abi_version() == FACEFORMER_ABI_VERSION);
    EXPECT(faceformer_info(&info, NULL) == FACEFORMER_STATUS_OK);
    printf("info %s\n", info ? info : "none");
    faceformer_string_free(info);
    EXPECT(whole_way(json, length, argv[2]));
    wrong_ways(json, length);
    free(json);
    printf("%d failed\n", failures);
    return failures ? 1 : 0;
}
