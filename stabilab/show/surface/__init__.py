"""Separatrix surfaces as meshes and pictures."""
