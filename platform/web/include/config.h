// Nettle, SHA-256 and base64 in plain C.
#pragma once
