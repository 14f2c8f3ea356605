    // Host: one word at a time.
    reg [31:0] answer;
    reg [31:0] words_in [0:255];

    task bus_write;
        transfer(1'b1, access_address, access_value);
    endtask

    // Word by word upwards, so that results are of one moment on a bus that can have it.
    task bus_read;
        integer n;
        for (n = 0; n < access_words; n = n + 1) begin
            transfer(1'b0, access_address + n, 32'd0);
            words_in[n] = answer;
        end
    endtask

    function [31:0] word(input integer index);
        word = words_in[index];
    endfunction

