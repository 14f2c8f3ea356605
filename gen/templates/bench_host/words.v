    // Host: one word at a time.
    reg [31:0] answer;
    reg [31:0] words_in [0:255];

    task write_word(input [31:0] address, input [31:0] value);
        transfer(1'b1, address, value);
    endtask

    // Word by word upwards, so that results are of one moment on a bus that can have it.
    task read_words(input [31:0] address, input integer words);
        integer n;
        for (n = 0; n < words; n = n + 1) begin
            transfer(1'b0, address + n, 32'd0);
            words_in[n] = answer;
        end
    endtask

    function [31:0] word(input integer index);
        word = words_in[index];
    endfunction

