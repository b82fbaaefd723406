/*
 * The C interface of faceformer: a wireframe drawing of a solid goes in, its faces and a valid
 * B-rep come out. Generated from ffi/capi/src; do not edit.
 *
 * Every call returns a status and sets its outputs before anything else: pointers to NULL,
 * lengths to 0. The last argument takes a message in English for the user, NULL if all went well;
 * free it with faceformer_string_free, or pass NULL if you do not want it. Text is UTF-8, JSON is
 * at most 256 MiB long. No call unwinds or throws into the caller.
 *
 * Handles never change after they are made, so several threads may use one at once; what differs
 * from that is said at the function. A handle may be freed in any order.
 *
 *     FaceformerDrawing *drawing; FaceformerFaces *faces; FaceformerSolid *solid; char *message;
 *     if (faceformer_drawing_read(json, len, &drawing, &message) == FACEFORMER_STATUS_OK
 *         && faceformer_identify(drawing, NULL, 0, NULL, NULL, &faces, &message) == FACEFORMER_STATUS_OK
 *         && faceformer_solid(drawing, faces, NULL, 0, NULL, NULL, &solid, &message) == FACEFORMER_STATUS_OK)
 *         faceformer_solid_write(solid, "part.step", "step", &message);
 *
 * C++ programs may prefer faceformer.hpp beside this file.
 *
 * SPDX-License-Identifier: LGPL-2.1-or-later
 */

#ifndef FACEFORMER_H
#define FACEFORMER_H

#include <stddef.h>
#include <stdint.h>

/**
 * Version of this interface. It grows when a function, a type or the meaning of a JSON field
 * changes so that an old caller would break; additions leave it.
 */
#define FACEFORMER_ABI_VERSION 1

/**
 * What a call returns. Anything but `FACEFORMER_STATUS_OK` comes with a message.
 */
enum FaceformerStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Done.
   */
  FACEFORMER_STATUS_OK = 0,
  /**
   * The work failed on sound input; the message says why and what to do.
   */
  FACEFORMER_STATUS_FAILED = 1,
  /**
   * The input is wrong: a null pointer, no UTF-8, no JSON of the expected form, too large, or
   * data that contradict each other.
   */
  FACEFORMER_STATUS_BAD_INPUT = 2,
  /**
   * The progress callback asked to stop.
   */
  FACEFORMER_STATUS_CANCELLED = 3,
  /**
   * A fault inside the library. The handles given to the call stay usable.
   */
  FACEFORMER_STATUS_PANIC = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum FaceformerStatus FaceformerStatus;
#else
typedef int32_t FaceformerStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A drawing that was read and checked.
 *
 * It never changes: several threads may use it at once, and it may be freed while faces or solids
 * made from it live on.
 */
typedef struct FaceformerDrawing FaceformerDrawing;

/**
 * Faces of one drawing.
 *
 * They never change: several threads may use them at once.
 */
typedef struct FaceformerFaces FaceformerFaces;

/**
 * A valid closed solid, or what could be built of its shell before an error.
 *
 * It never changes: several threads may use it at once.
 */
typedef struct FaceformerSolid FaceformerSolid;

/**
 * Hears how far a long call is; null if nobody listens.
 *
 * Gets the stage ("drawing", "identify", "lift", "plan" or "build"), the share done of that stage,
 * 0 to 1, and the pointer `user` given to the call. Returns 0 to cancel, anything else to go on. It
 * runs on the thread that made the call, and must not throw, jump out, or free the call's handles.
 */
typedef int32_t (*FaceformerProgress)(const char *stage, double share, void *user);

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Reads a drawing from `len` bytes of JSON, at most 256 MiB, and cleans it where its form asks
 * for that.
 *
 * Forms: the interchange format (`vertices` and `edges`; taken at its word), the released
 * Faceformer JSON (`edges` and `pairings`), and a plain list of edges `{"edges": [{"name":
 * "Edge1", "points": [[x, y], ...]}]}` (cleaned up: end points snapped, pieces of one curve
 * joined, curves recognised). Mistakes that can be drawn around, such as an edge that ends
 * freely, are findings of `faceformer_drawing_report`, not errors of this call.
 *
 * Returns `FACEFORMER_STATUS_BAD_INPUT` if the text is no drawing, is too large, or has a number
 * that is not finite; the message names the edge. Any thread may call this. Free `*out` with
 * `faceformer_drawing_free`.
 *
 * # Safety
 * `json` is valid for reads of `len` bytes, `out` is valid for writes, `message` is null or valid
 * for writes.
 */
FaceformerStatus faceformer_drawing_read(const char *json,
                                         size_t len,
                                         struct FaceformerDrawing **out,
                                         char **message);

/**
 * Tells what the drawing became and what is wrong with it, as a JSON object:
 * `{"drawing": ..., "sources": [[0], ...], "findings": [...], "tolerance": 1e-4}`.
 *
 * `drawing` is in the interchange format, with a recognised `curve` at each edge. `sources[e]`
 * are the edges of the input, counted from 0, that edge `e` was made from. A finding has
 * `severity` ("error", "warning", "notice"), `kind`, `message`, the `edges` of the input (from 0),
 * the `vertices` of the drawing (from 0) and the `points` concerned. `tolerance` is the distance
 * within which points became one; null if the drawing was not cleaned.
 *
 * Any thread may call this. Free `*json` with `faceformer_string_free`.
 *
 * # Safety
 * `drawing` is a live handle or null, `json` is valid for writes, `message` is null or valid for
 * writes.
 */
FaceformerStatus faceformer_drawing_report(const struct FaceformerDrawing *drawing,
                                           char **json,
                                           char **message);

/**
 * Frees a drawing. Null does nothing. No call may be using it.
 *
 * # Safety
 * `drawing` is null, or a live handle that is not used again.
 */
void faceformer_drawing_free(struct FaceformerDrawing *drawing);

/**
 * Identifies the faces of a drawing.
 *
 * `options_json` has `len` bytes: `{"engine": "rotation"}`, every key optional, null for the
 * defaults. `faceformer_info` lists the engines. `callback` is null or hears progress and may
 * cancel; it gets `user`.
 *
 * With `"model": "FILE"` the engine rotation uses the trained model in that file, with
 * `"model": "none"` its hand-made scores, and else the file that the environment variable
 * `FACEFORMER_MODEL` names, or the library's own model. If a model cannot be used, the hand-made
 * scores are, and the faces' `notices` say so. The paper's engines take a file in the same ways;
 * faceformer has a small model of its own, and without a model that can be used they refuse every
 * drawing.
 *
 * Returns `FACEFORMER_STATUS_FAILED` if the engine cannot handle the drawing (an edge ends freely,
 * no consistent faces exist; the message names the edge), `FACEFORMER_STATUS_CANCELLED` if the
 * callback returned 0. Any thread may call this, several at once with the same drawing. Free
 * `*out` with `faceformer_faces_free`.
 *
 * # Safety
 * `drawing` is a live handle or null, `options_json` is null or valid for reads of `len` bytes,
 * `callback` is null or may be called with `user`, `out` is valid for writes, `message` is null or
 * valid for writes.
 */
FaceformerStatus faceformer_identify(const struct FaceformerDrawing *drawing,
                                     const char *options_json,
                                     size_t len,
                                     FaceformerProgress callback,
                                     void *user,
                                     struct FaceformerFaces **out,
                                     char **message);

/**
 * Takes faces from the caller: `len` bytes of JSON in the form of `faceformer_faces_json`, edited
 * or from elsewhere. `{"faces": [{"type": "plane", "loops": [[1, 2, -3]]}]}` is enough.
 *
 * Every loop must be a closed walk over edges of `drawing`; whether the faces bound a solid is
 * found out by `faceformer_solid`.
 *
 * Returns `FACEFORMER_STATUS_BAD_INPUT` if the faces do not fit the drawing; the message names the
 * face. Any thread may call this. Free `*out` with `faceformer_faces_free`.
 *
 * # Safety
 * `drawing` is a live handle or null, `json` is valid for reads of `len` bytes, `out` is valid for
 * writes, `message` is null or valid for writes.
 */
FaceformerStatus faceformer_faces_read(const struct FaceformerDrawing *drawing,
                                       const char *json,
                                       size_t len,
                                       struct FaceformerFaces **out,
                                       char **message);

/**
 * Lists the faces as a JSON object: `{"engine": "rotation", "faces": [...], "alternatives":
 * [...], "notices": [...]}`.
 *
 * A face has `type` ("plane", "cylinder", "cone", "sphere", "torus", "other"), `loops` of signed
 * edge numbers (`k` is edge `k` of the drawing, counted from 1, walked forwards, `-k` backwards),
 * `confidence` from 0 to 1 and `evidence`. `alternatives` are further sets of faces, best first:
 * to use one, give its `faces` to `faceformer_faces_read`.
 *
 * Any thread may call this. Free `*json` with `faceformer_string_free`.
 *
 * # Safety
 * `faces` is a live handle or null, `json` is valid for writes, `message` is null or valid for
 * writes.
 */
FaceformerStatus faceformer_faces_json(const struct FaceformerFaces *faces,
                                       char **json,
                                       char **message);

/**
 * Frees faces. Null does nothing. No call may be using them.
 *
 * # Safety
 * `faces` is null, or a live handle that is not used again.
 */
void faceformer_faces_free(struct FaceformerFaces *faces);

/**
 * Version of the interface of the loaded library.
 *
 * Compare it with `FACEFORMER_ABI_VERSION` of the header after loading the library by hand. Any
 * thread may call this.
 */
uint32_t faceformer_abi_version(void);

/**
 * Tells what this library is, as a JSON object:
 * `{"version": "0.1.0", "abi": 1, "occt": "7.6.3", "occt_bundled": false, "engines":
 * ["rotation", ...], "default_engine": "rotation", "formats": ["step", "brep", "stl"]}`.
 *
 * Any thread may call this.
 *
 * # Safety
 * `json` is valid for writes, `message` is null or valid for writes.
 */
FaceformerStatus faceformer_info(char **json, char **message);

/**
 * Finds the depth of every vertex and the surface of every face, and which faces conflict, as a
 * JSON object: `{"depths": [...], "surfaces": [...], "conflicts": [{"face": 6, "vertices": [12],
 * "others": [2, 8], "residual": 0.1, "message": "face 7 conflicts with faces 3 and 9 at vertex
 * 12"}], ...}`.
 *
 * A conflict has a face that the depths contradict, the vertices where they do, and the other faces
 * there, all counted from 0; `residual` is how far off its surface it is, in drawing units.
 * `message` says it for the user, faces counted from 1. Without conflicts the list is empty.
 *
 * `options_json` has `len` bytes: `{"flip": false}`, every key optional, null for the defaults.
 * `callback` is null or hears progress and may cancel; it gets `user`.
 *
 * Returns `FACEFORMER_STATUS_FAILED` if depth cannot be had (the message says of which vertices),
 * `FACEFORMER_STATUS_BAD_INPUT` if `faces` belong to another drawing, `FACEFORMER_STATUS_CANCELLED`
 * if the callback returned 0. Any thread may call this, several at once with the same handles.
 * Free `*json` with `faceformer_string_free`.
 *
 * # Safety
 * `drawing` and `faces` are live handles or null, `options_json` is null or valid for reads of
 * `len` bytes, `callback` is null or may be called with `user`, `json` is valid for writes,
 * `message` is null or valid for writes.
 */
FaceformerStatus faceformer_lift(const struct FaceformerDrawing *drawing,
                                 const struct FaceformerFaces *faces,
                                 const char *options_json,
                                 size_t len,
                                 FaceformerProgress callback,
                                 void *user,
                                 char **json,
                                 char **message);

/**
 * Frees a string or message that this library returned. Null does nothing.
 *
 * Any thread may call this.
 *
 * # Safety
 * `text` is null, or came from this library and is freed once.
 */
void faceformer_string_free(char *text);

/**
 * Frees bytes that this library returned, given the length that came with them. Null does nothing.
 *
 * Any thread may call this.
 *
 * # Safety
 * `bytes` is null, or came from this library with the length `len` and is freed once.
 */
void faceformer_bytes_free(uint8_t *bytes, size_t len);

/**
 * Makes a solid from a drawing and its faces: depth, plan, and OpenCASCADE's B-rep of it.
 *
 * `options_json` has `len` bytes: `{"flip": false, "scale": 1.0, "orientation": "upright",
 * "alternatives": 0}`, every key optional, null for the defaults. `flip` takes the other of the two
 * depths that a drawing without perspective has; `scale` is model units per drawing unit, above 0;
 * `orientation` is "upright" (the model's axes along x, y, z) or "drawn" (as seen, z towards the
 * viewer). If the faces conflict or give no solid, as many of their `alternatives` as that are tried
 * in their order, and the first one without fault is taken; the report says so. Leave it at 0 where
 * the user chose the faces. `callback` is null or hears progress and may cancel; it gets `user`.
 *
 * A face whose surface is found but fits no solid is filled, and the plan's `notices` say so; the
 * faces count as being without a solid where `alternatives` are tried.
 *
 * Returns `FACEFORMER_STATUS_FAILED` if depth or a valid closed solid cannot be had; the message
 * names the face or edge. If OpenCASCADE had begun a shell by then, `*out` is NOT null but a
 * handle for inspection: its report has `"partial": true`, and `faceformer_solid_brep` gives the
 * partial shell; free it as any other. Returns `FACEFORMER_STATUS_BAD_INPUT` if `faces` belong to
 * another drawing, `FACEFORMER_STATUS_CANCELLED` if the callback returned 0.
 *
 * Any thread may call this, several at once with the same handles. Free `*out` with
 * `faceformer_solid_free`.
 *
 * # Safety
 * `drawing` and `faces` are live handles or null, `options_json` is null or valid for reads of
 * `len` bytes, `callback` is null or may be called with `user`, `out` is valid for writes,
 * `message` is null or valid for writes.
 */
FaceformerStatus faceformer_solid(const struct FaceformerDrawing *drawing,
                                  const struct FaceformerFaces *faces,
                                  const char *options_json,
                                  size_t len,
                                  FaceformerProgress callback,
                                  void *user,
                                  struct FaceformerSolid **out,
                                  char **message);

/**
 * Tells how the solid came about and what it is, as a JSON object: `{"partial": false, "report":
 * {"volume": ..., "area": ..., "face_counts": {"plane": 6, ...}, ...}, "error": null, "reading": 0,
 * "notices": [], "lift": ..., "plan": ...}`.
 *
 * `reading` says which faces the solid has: 0 those of `faces`, 1 the first of their alternatives;
 * if it is not 0, the one text in `notices` tells the user why. `lift` lists `conflicts` as
 * `faceformer_lift` does.
 *
 * `lift` has the depth of every vertex of the drawing, `plan` the points, curves and surfaces the
 * solid was built from. For a partial shell `partial` is true, `report` null and `error` the
 * message.
 *
 * Any thread may call this. Free `*json` with `faceformer_string_free`.
 *
 * # Safety
 * `solid` is a live handle or null, `json` is valid for writes, `message` is null or valid for
 * writes.
 */
FaceformerStatus faceformer_solid_report(const struct FaceformerSolid *solid,
                                         char **json,
                                         char **message);

/**
 * Gives the B-rep as OpenCASCADE's BREP text, format version 1, which every FreeCAD reads; of a
 * partial shell what there is of it.
 *
 * `*bytes` has `*length` bytes and no zero at the end. Any thread may call this. Free `*bytes` with
 * `faceformer_bytes_free`.
 *
 * # Safety
 * `solid` is a live handle or null, `bytes` and `length` are valid for writes, `message` is null or
 * valid for writes.
 */
FaceformerStatus faceformer_solid_brep(const struct FaceformerSolid *solid,
                                       uint8_t **bytes,
                                       size_t *length,
                                       char **message);

/**
 * Writes the solid to a file, which is replaced if it is there.
 *
 * `path` is UTF-8 and ends with a zero byte, as does `format`: "step", "brep" or "stl". STEP and STL
 * are in the units of `scale`; STEP calls them millimetres.
 *
 * Returns `FACEFORMER_STATUS_FAILED` if the file cannot be written, or the solid is only a partial
 * shell. Any thread may call this. OpenCASCADE's STEP writer has settings that are global to the
 * process: this library's own writes wait for each other, but where it shares the system's
 * OpenCASCADE with the program, do not write while the program itself reads or writes STEP in
 * another thread.
 *
 * # Safety
 * `solid` is a live handle or null, `path` and `format` are null or end with a zero byte, `message`
 * is null or valid for writes.
 */
FaceformerStatus faceformer_solid_write(const struct FaceformerSolid *solid,
                                        const char *path,
                                        const char *format,
                                        char **message);

/**
 * Frees a solid. Null does nothing. No call may be using it.
 *
 * # Safety
 * `solid` is null, or a live handle that is not used again.
 */
void faceformer_solid_free(struct FaceformerSolid *solid);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* FACEFORMER_H */
