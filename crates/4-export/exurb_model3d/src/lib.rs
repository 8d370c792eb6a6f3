//! The city as meshes: GLB, OBJ and perspective pictures.
