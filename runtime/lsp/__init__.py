"""The language server: what `icarus_lite.language` knows of a domain file, told to editors.

It needs the extra `lsp`: `pip install 'icarus-lite[lsp]'`. The rest of the package does without.
"""

from runtime.lsp.server import make_server, serve

__all__ = ["make_server", "serve"]
